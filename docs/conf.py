"""The site made of these pages (scripts/docs): Sphinx reads the Markdown as it stands."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
project = "kapitza"
version = release = re.search(r"project\(kapitza VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "index"
html_theme = "alabaster"
html_theme_options = {"page_width": "1100px", "fixed_sidebar": True}
html_copy_source = False
myst_heading_anchors = 3
myst_enable_extensions = ["smartquotes"]
smartquotes = False
