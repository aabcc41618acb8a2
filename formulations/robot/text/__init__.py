"""Safe reading of text that others wrote: whole files, XML, YAML and JSON, with the line of every value."""
