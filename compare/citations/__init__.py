"""What to cite: the papers behind every case, family, rung, algorithm and library, as BibTeX.

references.bib   every paper once
cited            the registry: what the code calls, and the papers behind it
used             what one run has used, from a problem, a ladder or the rows of a comparison
bibliography     the BibTeX of what was used
"""
