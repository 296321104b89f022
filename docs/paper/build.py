"""Makes the paper of docs/paper/paper.md: python docs/paper/build.py FOLDER

FOLDER/paper.html is made by markdown-it; FOLDER/paper.pdf by chromium, if it is installed. More than two pages are an
error.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

from markdown_it import MarkdownIt

SOURCE = Path(__file__).resolve().parent / "paper.md"
MOST_PAGES = 2
STYLE = """
@page { size: A4; margin: 14mm 15mm; }
body { font: 8.6pt/1.28 "DejaVu Serif", serif; text-align: justify; }
h1 { font-size: 15pt; text-align: left; }
h2 { font-size: 10pt; margin: 0.7em 0 0.2em; break-after: avoid; } p, ul, table { margin: 0.3em 0; }
td, th { padding: 0.1em 0.8em 0.1em 0; text-align: left; border-bottom: 0.4pt solid #999; } a { color: inherit; text-decoration: none; }
"""


def page(text: str) -> str:
    """The paper as one HTML page."""
    body = MarkdownIt("commonmark").enable("table").render(text)
    title = re.search(r"^# (.+)$", text, re.MULTILINE)
    return f"<!doctype html><meta charset='utf-8'><title>{title[1] if title else 'paper'}</title><style>{STYLE}</style>{body}"


def main() -> None:
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    html, pdf = folder / "paper.html", folder / "paper.pdf"
    html.write_text(page(SOURCE.read_text()))
    print(html)
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if not chromium:
        print("paper: chromium is not installed: no PDF", file=sys.stderr)
        return
    words = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer", f"--print-to-pdf={pdf}",
             html.as_uri()]
    subprocess.run(words, check=True, capture_output=True, timeout=300)
    pages = len(re.findall(rb"/Type\s*/Page\b", pdf.read_bytes()))
    print(f"{pdf}: {pages} pages")
    if pages > MOST_PAGES:
        sys.exit(f"paper: has {pages} pages; it may have {MOST_PAGES}")


if __name__ == "__main__":
    main()
