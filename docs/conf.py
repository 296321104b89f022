"""The site made of these pages (scripts/docs): Sphinx reads the Markdown as it stands."""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))  # for autodoc
project = "kapitza"
version = release = re.search(r"project\(kapitza VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
# Formulas without a network
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton", "sphinx-mathjax-offline"]
source_suffix = {".md": "markdown"}
root_doc = "index"
default_role = "code"  # of docstrings
html_theme = "furo"
html_title = f"kapitza {version}"
html_static_path = ["site/static"]
html_css_files = ["site.css"]
templates_path = ["site/templates"]
html_sidebars = {"**": [f"sidebar/{part}.html" for part in ("brand", "search", "scroll-start", "navigation")]
                 + ["versions.html", "sidebar/scroll-end.html"]}
html_copy_source = False
html_show_copyright = False
myst_heading_anchors = 3
myst_enable_extensions = ["dollarmath"]
smartquotes = False  # theta'' is no quotation
copybutton_exclude = ".linenos, .gp, .go"
linkcheck_timeout = 20  # s
linkcheck_retries = 2


def name_versions(app, page, template, context, tree):
    """The versions whose sites stand beside this one, for the sidebar: the newest first."""
    found = {path.parent.name for path in Path(app.outdir).parent.glob("*.*.*/index.html")} | {version}
    context["versions"] = sorted(found, key=lambda name: [int(part) for part in re.findall(r"\d+", name)], reverse=True)


def add_links_of_readme(app, page, source):
    """README is not a page of the site. `scripts/docs --links` checks its links together with those of the index."""
    if app.builder.name == "linkcheck" and page == "index":
        links = re.findall(r"\]\((https?://[^)\s]+)\)", (ROOT / "README.md").read_text())
        source[0] += "\n\n" + "\n".join(f"<{link}>" for link in links) + "\n"


def setup(app):
    app.connect("html-page-context", name_versions)
    app.connect("source-read", add_links_of_readme)
