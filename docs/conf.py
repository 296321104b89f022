"""The site made of these pages (scripts/docs): Sphinx reads the Markdown as it stands."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))  # for autodoc
project = "kapitza"
version = release = re.search(r"project\(kapitza VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "sphinx-mathjax-offline"]  # formulas without a network
source_suffix = {".md": "markdown"}
root_doc = "index"
default_role = "code"  # of docstrings
html_theme = "furo"
html_title = f"kapitza {version}"
html_copy_source = False
html_show_copyright = False
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
smartquotes = False  # theta'' is no quotation
copybutton_exclude = ".linenos, .gp, .go"
