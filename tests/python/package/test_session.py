"""The package in a Python session: runs of scenes in every form, what is refused, single starts, and what a result
tells of itself."""

import copy
import signal
import subprocess
import sys
import warnings

import h5py
import kapitza
import numpy as np
import pandas
import pytest
import xarray
import yaml
from conftest import PROGRAM, ROOT, wait_for
from hypothesis import given, settings
from hypothesis import strategies as st
from kapitza.compare import match_attractors
from kapitza.scene import Scene, flow

SMALL = ROOT / "scenes" / "small.yaml"
FEW = {"basin.theta.count": 24, "basin.velocity.count": 20, "basin.attractors.starts": 256}
FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.300}


@pytest.fixture(scope="module")
def result():
    return kapitza.run(SMALL, set=FEW, progress=False)


def test_a_scene_is_a_path_a_text_or_a_mapping(result, tmp_path):
    mapping = yaml.safe_load(SMALL.read_text()) | {"title": "A: small look", "pendulum": FIG12}
    mapping["basin"] |= {"theta": {"count": np.int64(24)}, "velocity": {"min": -2, "max": 2.0, "count": 20},
                         "attractors": {"starts": 256}}
    mapped = kapitza.run(mapping, progress=False)
    text = kapitza.run(SMALL.read_text(), output=tmp_path / "text.h5", set=FEW, ranks=2, progress=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # the text with every default was warned of a map table that nothing uses
        again = kapitza.run(result.scene, progress=False)
    assert mapped.title == "A: small look" and text.path == tmp_path / "text.h5"
    for other in (mapped, text, again):
        assert np.array_equal(other.labels(), result.labels())
    assert "written to" in result.summary


@pytest.mark.parametrize(("scene", "changes", "key", "value", "place"), [
    (SMALL, {"basin.theta.cont": 3}, "basin.theta.cont", "3", "--set basin.theta.cont=3"),
    (SMALL, {"basin.method": "guess"}, "basin.method", "guess", "--set basin.method=guess"),
    ("title: x\npendulum: {k: 0.1, damping: none, m: 0.3}\nbasin: {velocity: {min: -2, max: 2}}\n", None,
     "pendulum.damping", "none", "line 2, column 29"),
    ({"pendulum": FIG12, "basin": {"velocity": {"min": 2, "max": -2}}}, None, "basin.velocity.max", "-2", None),
    ({"pendulum": FIG12, "basin": {"theta": {"count": 5}}}, None, "basin.velocity", None, None),
])
def test_what_is_refused_is_named(scene, changes, key, value, place):
    for call in (kapitza.run, kapitza.check):
        with pytest.raises(kapitza.SceneError) as caught:
            call(scene, set=changes)
        assert (caught.value.key, caught.value.value) == (key, value), caught.value
        assert caught.value.place and place in (None, caught.value.place) and "error:" not in str(caught.value)


def test_what_is_no_scene_is_refused():
    with pytest.raises(TypeError, match="a scene is the path of a file"):
        kapitza.run(5)


def test_files_have_their_place_and_outputs_stay(result, tmp_path):
    (tmp_path / "a.yaml").write_text("pendulum: {k: x, damping: 1, m: 1}\n")
    with pytest.raises(kapitza.SceneError) as caught:
        kapitza.run(tmp_path / "a.yaml")
    assert caught.value.place == f"{tmp_path / 'a.yaml'}:1:15"
    with pytest.raises(kapitza.SceneError, match="exists") as caught:
        kapitza.run(SMALL, output=result.path)
    assert caught.value.key is None
    kept = kapitza.run(result.scene, output=result.path, resume=True, progress=False)
    assert np.array_equal(kept.labels(), result.labels())
    with pytest.raises(kapitza.SceneError, match="no such|cannot be opened"):
        kapitza.run("absent.yaml")


INTERRUPTED = """
import kapitza, signal, sys
# Tests in the background of a shell inherit that SIGINT is ignored
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    cells = {"basin.theta.count": 6000, "basin.velocity.count": 6000}
    kapitza.run(sys.argv[1], output="out.h5", set=cells, progress=False)
except KeyboardInterrupt as stop:
    print(stop)
"""


def test_ctrl_c_keeps_what_is_finished(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED, SMALL], cwd=tmp_path, stdout=subprocess.PIPE,
                               text=True)
    checkpoint = tmp_path / "out.h5.checkpoint"
    wait_for(lambda: process.poll() is not None or (checkpoint.exists() and checkpoint.stat().st_blocks > 64))
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate()
    assert said == "stopped; finished work is kept in out.h5.checkpoint, and resume=True goes on from it\n"
    assert checkpoint.exists() and not (tmp_path / "out.h5").exists()


def test_labels_are_flags_of_cf(result):
    labels, names = result.labels(), result.attractors["name"]
    values, words = labels.attrs["flag_values"], labels.attrs["flag_meanings"].split()
    assert values.dtype == labels.dtype and list(values) == list(range(-1, len(names))) and len(words) == len(values)
    assert words[0] == "not_settled" and words[1 + list(names).index("rotation +1/1")] == "rotation_+1_in_1"
    with xarray.open_dataset(result.path, group="basin", engine="h5netcdf") as stored:
        assert stored["attractor"].attrs["flag_meanings"] == labels.attrs["flag_meanings"]
        assert np.array_equal(stored["attractor"].attrs["flag_values"], values)


def test_a_result_tells_what_it_holds(result):
    table = result.attractors
    assert {"name", "period", "winding", "centre", "fraction", "multipliers", "strobe_theta"} <= set(table.columns)
    inverted = result.ids("inverted")
    assert table.loc[inverted[0], "centre"] == "inverted" and len(table.loc[inverted[0], "strobe_theta"]) == 1
    assert float(result.basin("inverted").mean()) == pytest.approx(sum(table["fraction"][inverted]), abs=1e-12)
    assert sum(result.basins_fractions().values()) == pytest.approx(1)
    assert "inverted" in repr(result) and "20 velocity x 24 theta" in repr(result) and "k = 0.00826446" in repr(result)
    page = result._repr_html_()
    assert page.count("<tr>") == 1 + min(len(table), 12) and "data:image/png" in page
    with pytest.raises(KeyError, match="the names are"):
        result.basin("nobody")
    for options, words in (({"breadth": "86mm"}, "'breadth' is no option of the kind basin; its options are width, "),
                           ({"width": "86"}, "width: 86 is not a width"),
                           ({"kind": "bassin"}, "the kinds are basin, ")):
        with pytest.raises(ValueError, match=words):
            result.plot(**options)


@pytest.mark.extensive
def test_two_results_beside_each_other(result):
    other = kapitza.run(SMALL, set=FEW | {"pendulum.drive_amplitude": 0.31}, progress=False)
    found = result.compare(other)
    assert result.compare(result).differing_share == 0 and match_attractors(result.attractors, result.attractors) == {
        index: index for index in result.attractors.index}
    for one, two in found.matched.items():
        assert result.attractors["centre"][one] == other.attractors["centre"][two]
    assert 0 < found.differing_share < 0.5 and found.table["fraction_second"].sum() == pytest.approx(1)
    assert np.allclose(found.tipping_probabilities().sum(axis=1), 1)
    assert "end elsewhere" in repr(found) and len(found.plot().axes) == 3
    with pytest.raises(ValueError, match="different windows"):
        _ = result.compare(kapitza.run(SMALL, set=FEW | {"basin.velocity.max": 1}, progress=False)).differing


@pytest.mark.extensive
def test_grids_of_different_counts_are_compared_on_the_coarser(result):
    """Of three times as many cells along each axis every third has the same centre."""
    finer = kapitza.run(SMALL, set=FEW | {"basin.theta.count": 72, "basin.velocity.count": 60}, progress=False)
    for found in (result.compare(finer), finer.compare(result)):
        assert found.differing.shape == (20, 24) and found.differing_share == 0
        assert np.allclose(found.tipping_probabilities().sum(axis=1), 1)


def test_only_like_motions_are_joined():
    """A motion that has doubled its period, turns otherwise, or lies elsewhere is not the same one, however near its
    points are."""
    def table(**changed):
        points = {"strobe_theta": [0.1] * 6, "strobe_velocity": [0.2] * 6}
        return pandas.DataFrame([{"name": "down 6-nodding", "period": 6, "winding": 0, "centre": "down"} | points
                                 | changed])
    assert match_attractors(table(), table(name="down 4-nodding")) == {0: 0}
    for changed in ({"period": 3}, {"winding": 6}, {"centre": "neither"}):
        assert match_attractors(table(), table(**changed)) == {}


def test_both_names_of_one_motion_are_shown(result):
    other = copy.copy(result)
    names = ["down 4-nodding" if name == "down 6-nodding" else name for name in result.attractors["name"]]
    other.__dict__["attractors"] = result.attractors.assign(name=names)
    assert "down 6-nodding → down 4-nodding" in list(result.compare(other).table["name"])


def test_a_sweep_keeps_the_window_of_the_scene():
    """Near the inverted state every start stands: the whole plane has other shares."""
    near = {"pendulum": FIG12, "basin": {"theta": {"min": 2.9, "max": 3.4, "count": 8},
                                         "velocity": {"min": -0.1, "max": 0.1, "count": 8}}}
    swept = kapitza.sweep(near, "drive_amplitude", [0.3, 0.31], "basin_fractions", starts=64,
                          progress=False).group("sweep")
    inverted = [branch for branch, code in enumerate(swept["branch_centre"].values) if code == 1]
    assert swept["fraction"].values[:, inverted].sum(axis=1) == pytest.approx([1, 1])


def test_where_labels_arrays_of_starts(result):
    table = kapitza.where(SMALL, [[3.1, "175 deg"], [0.1, "3.0"]], 0.0)
    assert table["theta"].tolist() == pytest.approx([3.1, np.radians(175), 0.1, 3.0])
    assert table["name"].tolist()[0] == "inverted" and table["name"][2] == "down" and table["decided"].all()
    assert list(table.columns[:8]) == ["theta", "velocity", "attractor", "name", "period", "winding", "settling_time",
                                       "decided"]
    with pytest.raises(kapitza.SceneError, match="THETA"):
        kapitza.where(SMALL, "up", 0)


@pytest.mark.extensive
def test_an_orbit_and_a_sweep():
    orbit = kapitza.orbit({"pendulum": FIG12}, "170 deg", 0, periods=5, progress=False)
    assert orbit.group("orbit")["theta"].values[0] == pytest.approx(np.radians(170)) and orbit.groups == ["pendulum",
                                                                                                          "orbit"]
    cycle = kapitza.orbit(Scene(SMALL, FEW), attractor="rotation +1/1", progress=False)
    assert cycle.group("orbit").attrs["winding"] == 1
    swept = kapitza.sweep({"pendulum": FIG12}, "drive_amplitude", [0.28, 0.3], "basin_fractions", starts=64,
                          progress=False)
    assert list(swept.group("sweep")["value"].values) == [0.28, 0.3]
    with pytest.raises(ValueError, match="give theta and velocity"):
        kapitza.orbit({"pendulum": FIG12})


def test_a_check_costs_nothing():
    found = kapitza.check(SMALL, set=FEW)
    assert found.cells == 480 and found.studies == ["basin"] and "count: 24" in found.scene
    assert str(found).startswith(f"{SMALL} is a valid scene.") and "\ncost " in found.text


def test_a_check_of_a_scene_whose_texts_look_like_its_lines():
    """What a title says is no fact about the run."""
    title = "many\n\ncells 7\nstudies none"
    found = kapitza.check(yaml.safe_load(SMALL.read_text()) | {"title": title.replace("\n", "  ")}, set=FEW)
    assert found.cells == 480 and found.studies == ["basin"]


@settings(max_examples=25)
@given(st.dictionaries(st.from_regex(r"[a-z]{1,8}", fullmatch=True), st.one_of(
    st.booleans(), st.integers(-10**18, 10**18), st.floats(allow_nan=False, allow_infinity=False),
    st.text("ab:#,'\"{}[]- é", min_size=1)),
    min_size=1, max_size=4))
def test_what_goes_into_a_scene_comes_out_of_it(values):
    """Texts are kept, numbers are written so that they read back as the same numbers; on the command line too."""
    words = {key: value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
             for key, value in values.items()}
    assert Scene({"title": "x", "basin": values}).tree()["basin"] == words
    assert Scene(f"basin: {flow(values)}\n").tree()["basin"] == words


def test_an_engine_answers_again_and_again(result):
    exact = kapitza.run(SMALL, set=FEW, method="exact", progress=False)
    with kapitza.Engine(Scene(SMALL, FEW)) as engine:
        labels = engine.frame((-np.pi, np.pi, -2, 2), (20, 24))
        assert labels.shape == (20, 24) and np.issubdtype(labels.dtype, np.integer)
        names = engine.attractors["name"]
        mine = exact.attractors["name"]
        assert np.mean([names[a] == mine[b] for a, b in zip(labels.ravel(), exact.labels().values.ravel(),
                                                            strict=True)]) == 1
        assert engine.where(3.1, 0)["name"] == "inverted" and len(engine.orbit(3.1, 0, 2)) == 129
        strong = engine.frame(None, (4, 4), pendulum={"quality_factor": 5, "drive_frequency": 11,
                                                      "drive_amplitude": 0.52})
        assert strong.shape == (4, 4) and "flutter" in set(engine.attractors["name"])
        with pytest.raises(kapitza.SceneError) as caught:
            engine.frame(pendulum={"k": 1})
        assert caught.value.key == "pendulum.damping"
        assert engine.frame(None, (3, 5)).shape == (3, 5)
    with pytest.raises(kapitza.SceneError):
        kapitza.Engine("pendulum: {k: 1}\n")


def test_names_texts_and_counts_that_mean_something_else_are_refused(tmp_path, monkeypatch):
    """Paths that begin with - are no options, a text with a comma is no two starts, a title has one line, a million
    ranks no machine."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "-s.yaml").write_text(SMALL.read_text())
    assert kapitza.check("-s.yaml", set=FEW).cells == 480
    assert kapitza.run("-s.yaml", "-r.h5", set=FEW, progress=False).path.exists()
    for theta in ("1,2\n3", "1\n2"):
        with pytest.raises(kapitza.SceneError, match="is not one number"):
            kapitza.where(SMALL, theta, 0)
    with pytest.raises(kapitza.SceneError, match="title"):
        kapitza.check(SMALL, set={"title": "a\nb"})
    with pytest.raises(ValueError, match="at most"):
        kapitza.run(SMALL, ranks=10**6)
    deep = "a: " + "[" * 3000 + "]" * 3000
    with pytest.raises(kapitza.SceneError):
        kapitza.check(deep + "\nb: 1\n")


def test_a_damaged_group_is_named_where_a_result_is_shown(result, tmp_path):
    path = tmp_path / "damaged.h5"
    path.write_bytes(result.path.read_bytes())
    with h5py.File(path, "r+") as file:
        del file["basin/theta"]
        file["basin/theta"] = np.zeros(3)
    assert "basin: damaged" in repr(kapitza.Result(path))


def test_files_are_measured_before_they_are_read(result, tmp_path):
    """A sparse file of a terabyte in place of a scene, of colours, of a table: a line, and no traceback for want of
    memory."""
    huge = tmp_path / "huge.yaml"
    with huge.open("wb") as file:
        file.truncate(1 << 40)
    for call in (kapitza.run, kapitza.check, lambda scene: kapitza.where(scene, 1, 0), kapitza.Engine,
                 lambda scene: kapitza.film(
            scene, "pendulum.m", [1, 2], tmp_path / "a.gif")):
        with pytest.raises(kapitza.SceneError, match="has more than 1000000 bytes; a scene has at most that many"):
            call(huge)
    for call in (lambda: result.plot(colours=huge), lambda: result.agree(huge)):
        with pytest.raises(ValueError, match="is larger than (1|64) MB; no (list of colours|table) is that large"):
            call()
    seen = subprocess.run([PROGRAM, "view", "--no-browser", huge], capture_output=True, text=True)
    assert (seen.returncode, seen.stderr) == (2,
                                              f"kapitza: error: {huge}: is larger than 1 MB; no scene is that large\n")


@pytest.mark.parametrize("call", [
    lambda result, theta: kapitza.where(result.scene, theta, 0), lambda result,
    theta: kapitza.orbit(result.scene, theta, 0, periods=1),
    lambda result, theta: result.at(theta, 0), lambda result, theta: result.probability(theta, 0, (0.1, 0.1))])
def test_a_large_angle_without_a_unit_is_noted(result, call):
    """175 is taken for radians, as the shell notes."""
    with pytest.warns(UserWarning, match='an angle without a unit is in rad; write "175 deg" for degrees'):
        call(result, 175)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        call(result, "175 deg")
        call(result, 28 * np.pi + 0.1)  # a computed angle


def test_where_without_damping_says_that_nothing_attracts():
    undamped = {"pendulum": {"k": 0.01, "damping": 0, "m": 0.3},
                "basin": {"velocity": {"min": -2, "max": 2}, "max_periods": 50}}
    with pytest.warns(UserWarning, match="no damping, so there are no attractors"):
        assert kapitza.where(undamped, 1, 0)["attractor"].tolist() == [-1]


def test_symbols_name_keys_of_the_pendulum():
    """Q, Omega and epsilon in a scene, in what a call changes, and in what a refusal reports."""
    scene = {"pendulum": {"Q": 5, "Omega": 11, "epsilon": 0.3},
             "orbit": {"start": {"theta": 1, "velocity": 0}, "periods": 3}}
    named = {"quality_factor": 4, "drive_frequency": 11, "drive_amplitude": 0.3}
    assert kapitza.check(scene, set={"pendulum.Q": 4}).scene == kapitza.check(scene, set={"pendulum": named}).scene
    with pytest.raises(kapitza.SceneError) as caught:
        kapitza.check(scene, set={"pendulum.Q": -1})
    assert (caught.value.key, caught.value.value) == ("pendulum.quality_factor", "-1")
    swept = kapitza.sweep(scene, "pendulum.epsilon", [0.1, 0.15, 0.2], "attractors", progress=False, starts=64)
    assert swept.group("sweep").attrs["parameter"] == "drive_amplitude"
    with kapitza.Engine(scene | {"basin": {"velocity": {"min": -2, "max": 2}}}) as engine:
        labels = engine.frame(None, (5, 5), pendulum={"Q": 5, "Omega": 11, "epsilon": 0.2})
        assert (labels == engine.frame(None, (5, 5),
                                       pendulum=named | {"quality_factor": 5, "drive_amplitude": 0.2})).all()


IN_A_JOB = """
import kapitza, sys
cells = {"basin.theta.count": 9, "basin.velocity.count": 9}
result = kapitza.run(sys.argv[1], set=cells, ranks=int(sys.argv[2]), progress=False)
assert result.labels().size == 81 and kapitza.check(sys.argv[1]).cells > 0
print("ended")
"""


@pytest.mark.extensive
@pytest.mark.parametrize("ranks", [pytest.param("1", marks=pytest.mark.extensive), "2"])
def test_the_package_works_within_a_job_of_mpi(tmp_path, ranks):
    """The variables of its launcher are not those of the processes that it starts."""
    (tmp_path / "job.py").write_text(IN_A_JOB)
    done = subprocess.run(["mpirun", "-n", "2", sys.executable, tmp_path / "job.py", SMALL, ranks], capture_output=True,
                          text=True)
    assert done.returncode == 0 and done.stdout.count("ended") == 2, done.stderr
