"""What the page's interactive charts show, as plain data; ``compare/report/script`` draws them.

One file per chart. Each function returns what its script of the same name reads, with ``alt``: one sentence
that states the result, for who does not see the picture.
"""
