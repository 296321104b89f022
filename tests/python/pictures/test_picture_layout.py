"""The page of a picture: its width, letters, legend and colours; what a stability chart can say of frequencies; crafted
files."""

import subprocess
import sys

import h5py
import kapitza
import matplotlib.image
import numpy as np
import pytest
from conftest import plot, with_extensive
from kapitza.plots.stability import columns_of_both
from kapitza.result import BadFile
from matplotlib.colors import to_rgb


@pytest.mark.parametrize("width, inches", with_extensive([("86mm", 86 / 25.4)], [("8.6cm", 86 / 25.4), ("6in", 6.0)]))
def test_a_picture_is_as_wide_as_it_is_asked_to_be(made_file, tmp_path, width, inches):
    assert plot("basin", made_file, "-o", tmp_path / "a.png", "--dpi", 100, "--width", width, "--font-size",
                8).returncode == 0
    assert abs(matplotlib.image.imread(tmp_path / "a.png").shape[1] - 100 * inches) <= 1


@pytest.mark.extensive
def test_the_legend_has_its_place(made_file, tmp_path):
    words = {}
    for place in ("right", "below", "none"):
        plot("basin", made_file, "-o", tmp_path / "a.svg", "--width", "120mm", "--legend", place, "--no-title")
        words[place] = (tmp_path / "a.svg").read_text()
    assert "rotation +1/1" in words["right"] and "rotation +1/1 " in words["below"] and "rotation" not in words["none"]
    assert all("A made-up plane" not in text for text in words.values())
    plot("basin", made_file, "-o", tmp_path / "a.png", "--dpi", 100, "--width", "86mm")
    image = matplotlib.image.imread(tmp_path / "a.png")
    assert np.std(image[: image.shape[0] // 3, 200:, :3]) > 0.05  # the plane takes the width, not half of it


@pytest.mark.extensive
def test_a_page_for_a_talk_is_a_larger_page(made_file):
    """Letters twice as large on a page twice as wide: lines, dots and panels are twice as large too."""
    usual, talk = (kapitza.Result(made_file).plot(width=f"{86 * scale}mm", font_size=8 * scale) for scale in (1, 2))
    sizes = [(line.get_markersize(), line.get_markeredgewidth()) for line in usual.axes[0].lines]
    assert sizes and np.allclose([(line.get_markersize(), line.get_markeredgewidth()) for line in talk.axes[0].lines],
                                 2 * np.array(sizes))
    legend = talk.legends[0].get_window_extent()
    assert talk.axes[0].get_position().width > 0.7 and 0 <= legend.x0 < legend.x1 <= talk.bbox.width


def test_colours_by_name(made_file, tmp_path):
    (tmp_path / "mine.yaml").write_text('inverted: "#010203"\nrotation +: teal\nnot settled: "#fefefe"\n')
    result = kapitza.Result(made_file)
    figure = result.plot(colours=tmp_path / "mine.yaml", no_dots=True)
    image, labels = figure.axes[0].images[0].get_array(), result.labels().values
    assert np.allclose(image[labels == 1], to_rgb("#010203")) and np.allclose(image[labels == 4], to_rgb("teal"))
    for text, said in (("inverted: reddish", "is not a colour"), ("[1]", "contains no colours"),
                       ("a: [", "cannot be read")):
        (tmp_path / "bad.yaml").write_text(text)
        done = plot("basin", made_file, "--colours", tmp_path / "bad.yaml")
        assert done.returncode == 2 and said in done.stderr


@pytest.mark.parametrize("words", [["--width", "86"], ["--width", "0mm"], ["--font-size", "1"], ["--legend", "left"]])
def test_pages_that_are_none(made_file, words):
    assert plot("basin", made_file, *words).returncode == 2


def test_frequencies_are_drawn_where_stability_was_asked():
    """A grid over k tells nothing of frequencies between its columns: the nearest one said "both stable" at zero
    drive."""
    k = np.linspace(-0.25, 0.25, 4001)
    down, inverted = columns_of_both(k)
    assert np.allclose(k[down], -k[inverted], atol=1e-12) and (np.diff(k[down]) < 0).all() and k[down][-1] > 0
    omega = 1 / np.sqrt(k[down])
    assert (np.diff(omega) / omega[1:] < 0.03).all() and omega[0] == pytest.approx(2) and omega[-1] > 20
    for few in (np.linspace(-1, 2.25, 131), np.linspace(0.1, 1, 500), np.linspace(-0.1, 0.25, 1000)):
        with pytest.raises(BadFile, match="a scene with such a chart"):
            columns_of_both(few)


def crafted(made_file, attribute, value, group="/"):
    with h5py.File(made_file, "r+") as file:
        file[group].attrs[attribute] = value
    return made_file


@pytest.mark.extensive
def test_titles_of_wrong_types_are_replaced(made_file, tmp_path):
    crafted(made_file, "title", [1, 2, 3])
    crafted(made_file, "scene_resolved", 5)
    result = kapitza.Result(made_file)
    assert result.title == "made" and result.scene == "5" and "made" in repr(result)
    done = plot("report", made_file, "-o", tmp_path / "r.html")
    assert (done.returncode, done.stderr) == (0, "")
    with h5py.File(made_file, "r+") as file:
        file.attrs.create("title", b"\xed\xa0\x80 a surrogate", dtype=h5py.string_dtype("utf-8"))
    done = plot("report", made_file, "-o", tmp_path / "s.html")
    assert done.returncode in (0, 1) and "Traceback" not in done.stderr
    assert not (tmp_path / "s.html").exists() or (tmp_path / "s.html").stat().st_size > 0


def test_a_crash_of_the_library_is_one_line():
    """What damaged bytes do to HDF5 now and then: the command says so in one line."""
    code = ("import os, signal, sys\nfrom kapitza.exit_status import run_apart\n"
            "run_apart(lambda: (print('free(): invalid pointer', file=sys.stderr), os.kill(os.getpid(), "
            "signal.SIGABRT)))")
    done = subprocess.run([sys.executable, "-c", code], env={}, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr == "kapitza: error: the file is damaged: reading it crashed the HDF5 library\n"
