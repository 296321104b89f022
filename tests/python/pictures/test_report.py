"""The report: one file that needs nothing else, whose numbers are those of the result."""

import hashlib
import html
import re
import shutil
from contextlib import chdir

import h5py
import numpy as np
import pytest
from conftest import ROOT, plot
from explorer_page import browser
from kapitza.result import Result


def write_report(*arguments, folder=ROOT):
    with chdir(folder):
        return plot("report", *arguments)


@pytest.fixture(scope="module")
def report(small_result, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "small.html"
    done = write_report(small_result, "-o", path)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{path}\n", "")
    return path


def test_it_holds_pictures_attractors_numbers_scene_and_provenance(report, small_result):
    text, result = report.read_text(), Result(small_result)
    assert text.count('src="data:image/png;base64,') == 2
    table = result.group("attractors")
    rows = re.findall(r"<tr><td><span.*?</span>(\d+) (.*?)</td>(.*?)</tr>", text)
    assert [(int(row[0]), row[1].replace("−", "-")) for row in rows] == list(enumerate(map(str, table["name"].values)))
    cells = [re.findall(r">([^<]*)</td>", row[2]) for row in rows]
    assert [float(row[3]) for row in cells] == pytest.approx(
        np.hypot(table["multiplier_re"].values[:, 0], table["multiplier_im"].values[:, 0]), abs=5.1e-7)
    assert [float(row[6].rstrip(" %")) for row in cells] == pytest.approx(100 * table["fraction"].values, abs=0.051)
    basin = result.group("basin").attrs
    exponent, error = basin["uncertainty_exponent"], basin["uncertainty_exponent_stderr"]
    assert f">{float(exponent):.10g} ± {float(error):.2g}<" in text
    assert result.attributes["scene"].rstrip() in html.unescape(text) and "max_periods: 2000" in text
    assert result.attributes["git_revision"] in text and hashlib.sha256(small_result.read_bytes()).hexdigest() in text


@pytest.mark.extensive
def test_intervals_stand_beside_their_numbers(small_result, tmp_path):
    shutil.copy(small_result, tmp_path / "more.h5")
    with h5py.File(tmp_path / "more.h5", "a") as file:
        file["basin"].attrs.update({"wrong": 0.004, "wrong_low": 0.003, "wrong_high": 0.0055})
    assert write_report("more.h5", folder=tmp_path).stdout == "more.html\n"
    text = (tmp_path / "more.html").read_text()
    assert ">basin: wrong</td><td class=number>0.004 (0.003 to 0.0055)<" in text and "wrong low" not in text


@pytest.mark.extensive
def test_it_needs_nothing_else_and_is_the_same_again(report, small_result, tmp_path):
    text = report.read_text()
    outside = [link for link in re.findall(r'(?:src|href)="([^"]*)"', text) if not link.startswith("data:")]
    assert not outside and "<script" not in text and "@import" not in text and "url(" not in text
    write_report(small_result, "-o", tmp_path / "again.html")
    assert (tmp_path / "again.html").read_bytes() == report.read_bytes()


@pytest.mark.extensive
def test_words_of_a_scene_are_no_html(small_result, tmp_path):
    shutil.copy(small_result, tmp_path / "crafted.h5")
    with h5py.File(tmp_path / "crafted.h5", "a") as file:
        file.attrs["title"], file.attrs["scene"] = "a < b & c", "</pre><script>alert(1)</script>"
    write_report("crafted.h5", folder=tmp_path)
    text = (tmp_path / "crafted.html").read_text()
    assert "<title>a &lt; b &amp; c</title>" in text and "<script" not in text


@pytest.mark.extensive
def test_a_result_without_a_grid_has_its_own_pictures(model):
    result = model({"k": 1 / 121, "damping": 1 / 55, "m": 0.3},
                   orbit={"start": {"theta": 3, "velocity": 0}, "periods": 20}, potential={"drive_amplitudes": [0.3]})
    page = result.path.with_suffix(".html")
    assert write_report(result.path, "-o", page).returncode == 0
    assert page.read_text().count("data:image/png") == 2 and "<h2>Attractors" not in page.read_text()


@pytest.mark.parametrize(("arguments", "status", "message"), [
    (["nothing.h5"], 1, "kapitza: error: nothing.h5: no such file"),
    (["README.md"], 1, "kapitza: error: README.md: not an HDF5 file"),
    (["README.md", "-o", "x.pdf"], 2, "must end in .html"),
])
def test_what_cannot_be_reported_is_said(arguments, status, message):
    done = write_report(*arguments)
    assert done.returncode == status and message in done.stderr and "Traceback" not in done.stderr


@pytest.mark.extensive
def test_it_opens_in_a_browser_from_the_file_system(report, tmp_path):
    with browser(tmp_path, "1140,1400") as driver:
        driver.get(report.as_uri())
        widths = driver.execute_script(
            "return [...document.images].map((image) => image.complete && image.naturalWidth)")
        assert len(widths) == 2 and all(width > 500 for width in widths) and "small look" in driver.title
        assert [entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"
                and "favicon" not in entry["message"]] == []
