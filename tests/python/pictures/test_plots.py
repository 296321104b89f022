"""The plotting script: every mode draws, draws what the file says, and files that cannot be used are refused in one
line."""

import subprocess
import sys

import h5py
import matplotlib.image
import numpy as np
import pytest
from conftest import EXTENSIVE, PROGRAM, ROOT, run_script, with_extensive
from conftest import plot as plot_kind
from kapitza import Result, style
from kapitza.command import KINDS, main
from kapitza.plots.basin import chosen_ids, draw_one
from kapitza.plots.window_axes import Plane
from kapitza.representation import main_kind
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure


def plot(*arguments):
    return plot_kind("basin", *arguments)


@pytest.mark.extensive
@pytest.mark.parametrize("command", [[PROGRAM, "plot", "basin"], [sys.executable, ROOT / "scripts" / "plot_basin.py"]])
def test_it_is_drawn_by_the_program_and_by_a_script(made_file, tmp_path, command):
    done = subprocess.run([*command, made_file], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "made.png\n", "")
    assert (tmp_path / "made.png").is_file()


def test_the_scripts_draw_kinds_that_exist():
    for path in (ROOT / "scripts").glob("plot_*.py"):
        assert path.stem[5:] in KINDS and f'main("{path.stem[5:]}")' in path.read_text()


@pytest.mark.parametrize("options", with_extensive(
    ["--shade --centre inverted --no-legend", "--quantity settling_time", "--quantity evidence",
     "--attractor inverted"],
    ["", "--attractor 2"]))
def test_every_mode_draws(made_file, tmp_path, options):
    done = plot(made_file, "-o", tmp_path / "out.png", "--dpi", 100, *options.split())
    assert (done.returncode, done.stderr) == (0, "")
    image = matplotlib.image.imread(tmp_path / "out.png")
    assert image.shape[1] > 600 and image[..., :3].std() > 0.05


@pytest.mark.parametrize("suffix, first", with_extensive([("svg", b"<?xml")], [("png", b"\x89PNG"), ("pdf", b"%PDF")]))
def test_formats_are_what_they_say_and_repeatable(made_file, tmp_path, suffix, first):
    pictures = [tmp_path / f"{name}.{suffix}" for name in "ab"]
    for picture in pictures:
        assert plot(made_file, "-o", picture, "--dpi", 40).returncode == 0
    assert pictures[0].read_bytes().startswith(first)
    assert pictures[0].read_bytes() == pictures[1].read_bytes()


def test_the_legend_gives_names_and_shares_and_the_axis_degrees(made_file, tmp_path):
    """Attractors of one name have their ids."""
    assert plot(made_file, "-o", tmp_path / "out.svg", "--degrees").returncode == 0
    text = (tmp_path / "out.svg").read_text()
    labels = Result(made_file).group("basin")["attractor"].values
    share = style.share_text(np.mean(labels == 4))
    assert "rotation +1/1" in text and "not settled" in text and share in text
    assert "inverted 3-nodding (2)" in text and "inverted 3-nodding (3)" in text and "rotation +1/1 (" not in text
    assert all(f">{tick}°<" in text for tick in ("−180", "−90", "0", "90",
                                                 "180")) and "π" not in text and "(rad)" not in text


def test_black_and_white_draws_just_that_basin(made_file):
    result = Result(made_file)
    basin, attractors = result.group("basin"), result.group("attractors")
    assert chosen_ids(result, attractors, "inverted 3-nodding") == [2, 3]
    assert chosen_ids(result, attractors, "3") == [3]
    axes = draw_one(Figure().add_subplot(), basin, attractors, [2, 3])
    drawn = axes.images[0].get_array()[..., 0] == 0
    assert np.array_equal(drawn, np.isin(basin["attractor"].values, [2, 3]))
    assert style.share_text(drawn.mean()) in axes.get_legend().get_texts()[1].get_text()


@pytest.mark.parametrize("title, suffix", with_extensive(
    [(r"$\frac{1}$ 100 % of $m and $k, \$ 倒立摆 🎈", "svg")],
    [(r"$\frac{1}$", "png"), ("倒立摆 🎈", "png"), ("倒立摆 🎈", "pdf")]))
def test_a_title_is_plain_text(made_file, tmp_path, title, suffix):
    with h5py.File(made_file, "r+") as file:
        file.attrs["title"] = title
    done = plot(made_file, "-o", tmp_path / f"out.{suffix}", "--dpi", 30)
    assert (done.returncode, done.stderr) == (0, "")
    if suffix == "svg":
        assert title in (tmp_path / "out.svg").read_text()


def pixels(made_file, colour, *options):
    """How many pixels of the picture have the colour."""
    picture = made_file.with_name("pixels.png")
    assert plot(made_file, "-o", picture, "--no-legend", "--dpi", 150, *options).returncode == 0
    image = matplotlib.image.imread(picture)[..., :3]
    return int(np.all(np.abs(image - to_rgb(colour)) < 0.004, axis=-1).sum())


@pytest.mark.extensive
@pytest.mark.parametrize("cells", [1])
def test_dots_never_cover_a_small_basin(made_file, cells):
    """The basin of a rotation is a few cells around its strobe point, most of which a dot of the usual size would
    hide."""
    with h5py.File(made_file, "r+") as file:
        distance = np.hypot(file["basin/theta"][:] - 3.0, file["basin/velocity"][:][:, None] - 1.1)
        labels = np.zeros(distance.shape, "i2")
        labels.flat[distance.ravel().argsort()[:cells]] = 4
        file["basin/attractor"][:] = labels
    colour = style.KINDS["rotation +"]
    assert pixels(made_file, colour) >= 0.75 * pixels(made_file, colour, "--no-dots") > 100


def test_a_strobe_point_on_the_seam_shows_on_both_edges(made_file):
    plane = Plane(Result(made_file).group("basin"), "down")
    theta, velocity = plane.inside([[-np.pi, np.nan]], [[0.0, np.nan]])
    assert np.allclose(sorted(theta), [-np.pi, np.pi]) and np.all(velocity == 0)


@pytest.mark.parametrize("arguments, words", [
    (["--attractor", "nobody"], "has no attractor nobody"),
    (["-o", "out.gif"], "must end in"),
    (["--attractor", "0", "--shade"], "cannot be combined"),
    (["--dpi", "0"], "0 is out of range"),
    (["--dpi", "fine"], "invalid resolution"),
    (["-o", "absent/out.png"], "kapitza: error: absent/out.png: No such file or directory"),
])
def test_wrong_requests_are_refused(made_file, arguments, words):
    done = plot(made_file, *arguments)
    assert done.returncode != 0 and words in done.stderr and "Traceback" not in done.stderr


def damage(path, how):
    if how == "missing":
        path.unlink()
    elif how == "folder":
        path.unlink()
        path.mkdir()
    elif how == "empty":
        path.write_bytes(b"")
    elif how == "text":
        path.write_text("not a file of this kind")
    elif how == "truncated":
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    else:
        with h5py.File(path, "r+") as file:
            if how == "foreign":
                del file.attrs["program"]
            elif how == "no basin":
                del file["basin"]
            elif how == "no labels":
                del file["basin/attractor"]
            elif how == "no pendulum":
                del file["pendulum"]
            elif how == "no parameters":
                del file["pendulum"].attrs["k"]
            elif how == "parameter of text":
                file["pendulum"].attrs["k"] = "half"
            else:
                write_crafted_file(file, how)


def write_crafted_file(file, how):
    """What no run writes: each of these once ended in a traceback, a wrong picture or no end at all."""
    labels, theta = file["basin/attractor"], file["basin/theta"]
    if how == "unknown label":
        labels[3, 4] = 999
    elif how == "axis not finite":
        theta[7] = np.nan
    elif how == "axis down":
        theta[:] = theta[:][::-1]
    elif how == "unknown evidence":
        file["basin/evidence"][0, 0] = 77
    elif how == "period below zero":
        file["attractors/period"][0] = -1
    elif how == "infinite cells":
        replace(file, "basin/attractor", shape=(10**6, 10**5), dtype="i2", chunks=(1000, 1000))
    elif how == "external data":
        replace(file, "basin/attractor", shape=labels.shape, dtype="i2",
                external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])
    elif how == "external link":
        del file["basin/attractor"]
        file["basin/attractor"] = h5py.ExternalLink("/tmp/other.h5", "/data")
    elif how == "virtual data":
        layout = h5py.VirtualLayout(labels.shape, "i2")
        layout[:] = h5py.VirtualSource("/tmp/other.h5", "data", labels.shape)
        del file["basin/attractor"]
        file["basin"].create_virtual_dataset("attractor", layout)
    elif how == "turned":
        turned = labels[:].T
        replace(file, "basin/attractor", data=turned)
        for axis, name in enumerate(("theta", "velocity")):
            file["basin/attractor"].dims[axis].attach_scale(file["basin"][name])
    elif how == "text for numbers":
        replace(file, "attractors/period", data=list("abcdef"), dtype=h5py.string_dtype())
        file["attractors/period"].dims[0].attach_scale(file["attractors/attractor"])
    elif how == "no dimensions":
        replace(file, "attractors/period", data=[1, 2])


def replace(file, name, **contents):
    """Another dataset under the name."""
    del file[name]
    file.create_dataset(name, **contents)


@pytest.mark.parametrize("how, words", [
    ("missing", "no such file"),
    ("folder", "not a file"),
    ("empty", "not an HDF5 file"),
    ("text", "not an HDF5 file"),
    ("truncated", "truncated"),
    ("foreign", "not a result of kapitza"),
    ("no basin", "holds no basin"),
    ("no labels", "lacks attractor"),
    ("no pendulum", "lacks the group pendulum"),
    ("no parameters", "lacks k, beta or m"),
    ("parameter of text", "lacks k, beta or m"),
    ("unknown label", "some cells have ids of attractors that the file does not list"),
    ("axis not finite", "theta is an axis with values that are not finite"),
    ("axis down", "theta is an axis that does not go up"),
    ("unknown evidence", "evidence has values that mean nothing"),
    ("period below zero", "period has values that mean nothing"),
    ("infinite cells", "holds 200 GB, too much for a picture"),
    ("external data", "keeps data in another file"),
    ("external link", "keeps data in another file"),
    ("virtual data", "keeps data in another file"),
    ("turned", "basin/attractor is not over velocity and theta"),
    ("text for numbers", "period is of another type"),
    ("no dimensions", "attractors/period is not over attractor"),
])
def test_files_that_cannot_be_used_get_one_line(made_file, tmp_path, how, words):
    damage(made_file, how)
    done = plot(made_file, "-o", tmp_path / "out.png")
    assert done.returncode == 1 and not (tmp_path / "out.png").exists()
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"kapitza: error: {made_file}: ") and words in line


def test_flipped_bytes_never_give_a_traceback(made_file, tmp_path):
    whole = made_file.read_bytes()
    generator = np.random.default_rng(5)
    for _ in range(12):
        damaged = bytearray(whole)
        for place in generator.integers(0, len(whole), 40):
            damaged[place] ^= 0xFF
        made_file.write_bytes(damaged)
        done = plot(made_file, "-o", tmp_path / "out.png", "--dpi", 40)
        assert done.returncode in (0, 1) and "Traceback" not in done.stderr, done.stderr


def test_a_motion_without_mirror_image_has_the_colour_of_its_kind(made_file):
    """As on a tilted shaker: only the second of two mirror partners is darker."""
    attractors = Result(made_file).group("attractors")
    usual = style.colours(attractors)
    alone = style.colours(attractors.assign(mirror=attractors["mirror"] * 0 - 1))
    assert alone[:3] == usual[:3] and alone[0] == style.KINDS["down"] and usual[3] != usual[2]


def from_program(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True)


def test_the_program_draws_the_main_study_and_says_what_a_file_holds(made_file, tmp_path):
    alone = tmp_path / "alone.svg"
    assert from_program("plot", made_file, "-o", alone).stdout == f"{alone}\n"
    assert main_kind(Result(made_file)) == "basin" and "rotation +1/1" in alone.read_text()
    said = from_program("info", made_file).stdout
    assert said == "\n".join(repr(Result(made_file)).splitlines()[1:]) + "\n" and "inverted" in said
    if EXTENSIVE:
        refused = from_program("info", tmp_path / "none.h5")
        assert (refused.returncode, refused.stderr) == (1, f"kapitza: error: {tmp_path / 'none.h5'}: no such file\n")
        assert from_program("plot", made_file, "-o", tmp_path / "alone.png", "--dpi", "40").returncode == 0
        assert plot(made_file, "-o", tmp_path / "named.png", "--dpi", "40").returncode == 0
        assert (tmp_path / "alone.png").read_bytes() == (tmp_path / "named.png").read_bytes()
        refused = from_program("plot", tmp_path / "none.h5")
        assert (refused.returncode, refused.stderr) == (1, f"kapitza: error: {tmp_path / 'none.h5'}: no such file\n")
    usage = run_script(main)
    assert usage.returncode == 2 and "KIND: atlas, basin" in usage.stderr
    assert from_program("info").stderr == "kapitza: error: info: FILE is missing; kapitza info FILE\n"
