"""The pages in docs/: each is in the index, links lead somewhere, and the site is made of them without a warning."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

DOCS = ROOT / "docs"
PAGES = [DOCS / "index.md", *sorted(DOCS.glob("*/*.md"))]


def name_of(page):
    """As the index says it: user, or start/install."""
    return str(page.relative_to(DOCS).with_suffix(""))


def test_every_page_is_in_the_index():
    index = (ROOT / "docs" / "index.md").read_text()
    listed = re.findall(r"^([\w/-]+)$", index, re.MULTILINE)
    assert sorted(listed) == sorted({name_of(path) for path in PAGES} - {"index"})
    assert all(f"({name}.md)" in index for name in listed)


def test_every_page_opens_with_what_it_answers():
    """A sentence under the title, before any heading, list, table, picture or command."""
    assert not [path.name for path in PAGES if not re.match(r"# .+\n\n[A-Z]", path.read_text())]


@pytest.mark.parametrize("page", [ROOT / "README.md", *PAGES], ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_to_files(page):
    links = re.findall(r"\]\((?!https?:)([^)#\s]+)", page.read_text())
    assert not [link for link in links if not (page.parent / link).exists()]


def test_the_list_of_changes_stays_short():
    """It had 98 kB, one release 169 entries."""
    text = (ROOT / "CHANGELOG.md").read_text()
    assert len(text) <= 12_000
    assert len(re.findall(r"^## ", text, re.MULTILINE)) == len(re.findall(r"^\*\*Breaks\.", text, re.MULTILINE)) + 1


FOLDERS = "tests|scripts|src|include|docs|benchmarks|packaging|python|scenes|web|cmake"


def test_pages_name_only_what_exists():
    """Paths, tests in Python and names for `ctest -R`. Words in capitals stand for names."""
    tests = [path for path in (ROOT / "tests").rglob("*") if path.suffix in (".c", ".cmake")]
    known = "".join(path.read_text() for path in tests
                    if path.suffix == ".cmake") + " ".join(path.stem for path in tests)
    missing = []
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *PAGES):
        text = page.read_text()
        paths = re.findall(rf"(?<![\w./<-])((?:{FOLDERS})/[\w./*-]*\w)", text)
        paths += [f"tests/python/*/{name}" for name in re.findall(r"(?<![/\w])test_\w+\.py", text)]
        missing += [(page.name, name) for name in paths if not re.search(r"[A-Z]{4}", name)
                    and not list(ROOT.glob(name))]
        missing += [(page.name, name) for name in re.findall(r"ctest -R ([\w.]+)", text)
                    if name.rsplit(".")[-1] not in known]
    assert missing == []


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, made without a warning."""
    for module in ("sphinx", "myst_parser", "furo", "sphinx_copybutton"):
        pytest.importorskip(module, reason="scripts/requirements-docs.txt is not installed: the site is not made")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "--quiet", "--fail-on-warning", "-b", "html", ROOT / "docs",
               folder / "site"]
    done = subprocess.run([*command, "-d", folder / "doctrees"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / "site"


def test_the_site_has_every_page(site):
    pages = [(site / f"{name_of(path)}.html").read_text() for path in PAGES]
    assert all("<h1>" in page for page in pages) and "howto/questions.html" in pages[PAGES.index(DOCS / "index.md")]
    version = re.search(r"project\(kapitza VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    assert all(f"../{version}/index.html" in page for page in pages)
    assert "kapitza.Result.labels" in (site / "reference" / "python.html").read_text()


@pytest.mark.extensive
def test_no_page_is_wider_than_a_phone(site):
    if not shutil.which("chromedriver"):
        pytest.skip("no chromium and chromium-driver: the pages are not opened at a phone's width")
    command = [sys.executable, ROOT / "tests" / "tools" / "phone_pages.py", site]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.endswith(" pages, 0 too wide\n"), done.stdout + done.stderr
