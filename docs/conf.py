"""The documentation site: ``python -m sphinx -W docs build/docs``; nothing is fetched and no example is run."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]

project = "timebound"
author = "The timebound authors"
html_title = "timebound"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "extension"]
exclude_patterns = ["extension"]
html_theme = "furo"
pygments_style, pygments_dark_style = "a11y-light", "a11y-high-contrast-dark"
html_math_renderer = "mathml"  # of the extension: no script and no font from elsewhere
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_copyright = False
smartquotes = False  # --option is no dash
html_show_sourcelink = False

myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"  # the tests run the notebooks; what is stored in them is shown
nb_render_markdown_format = "myst"  # answers of notebooks have tables

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have types, shapes and units
napoleon_google_docstring = False
napoleon_use_ivar = True
