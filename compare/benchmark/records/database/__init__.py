"""The file ``results.sqlite``: its tables, their versions, its transactions, and how values are written."""
