"""Good scenes: numbers as typed, options as written, the resolved text, help and reference."""

import math
import subprocess

import pytest
import yaml
from conftest import EXTENSIVE, PROGRAM, ROOT, with_extensive
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_bad_scenes import GOOD, program

SETTINGS = settings(max_examples=100 if EXTENSIVE else 3, suppress_health_check=[HealthCheck.function_scoped_fixture])
FINITE = st.floats(allow_nan=False, allow_infinity=False)


def resolved(folder, *arguments, scene=GOOD):
    """The resolved text that `check --all` prints behind the cost."""
    (folder / "scene.yaml").write_text(scene, encoding="utf-8")
    status, out, err = program(folder, "check", "scene.yaml", "--all", *arguments)
    assert (status, err) == (0, "")
    return out.decode().split("\n\n")[1]


def at(tree, path):
    for name in path.split("."):
        tree = tree[name]
    return tree


@SETTINGS
@given(value=FINITE)
def test_reals_are_read_exactly(tmp_path, value):
    scene = GOOD.split("basin:")[0] + "potential: {drive_amplitudes: [0.3]}\n"  # a basin would have its steps tried
    text = resolved(tmp_path, "--set", f"pendulum.drive_amplitude={value!r}", scene=scene)
    line = next(line for line in text.splitlines() if "drive_amplitude" in line)
    assert float(line.split(":")[1]) == value


@SETTINGS
@given(value=st.integers(-(2**70), 2**70) | st.integers(0, 1_100_000))
def test_integers_are_in_range_or_refused(tmp_path, value):
    (tmp_path / "scene.yaml").write_text(GOOD)
    status, out, err = program(tmp_path, "check", "scene.yaml", "--all", "--set", f"basin.theta.count={value}")
    if 1 <= value <= 1_000_000:
        assert status == 0 and at(yaml.safe_load(out.decode().split("\n\n")[1]), "basin.theta.count") == value
    else:
        assert status == 2 and "basin.theta.count" in err and err.count("\n") == 1


def test_last_option_wins(tmp_path):
    text = resolved(tmp_path, "--set", "basin.theta.count=3", "--set", "basin.theta={count: 4}", "--set",
                    "basin.theta.count=5")
    assert at(yaml.safe_load(text), "basin.theta.count") == 5


@pytest.mark.parametrize(("by_symbol", "by_name", "options"), [
    ("pendulum: {Q: 5, Omega: 11, epsilon: 0.3}\nattractors: {velocity: {min: -1, max: 1}}\n",
     "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}\nattractors: {velocity: {min: -1, max: "
     "1}}\n",
     [["pendulum.Q=4"], ["pendulum={Q: 4, Omega: 12, epsilon: 0.1}"]]),
    ("pendulum: {k: 0.01, beta: 0.1, m: 0.5}\nsweep: {parameter: beta, min: 0.1, max: 0.2, count: 3, measure: "
     "[attractors]}\n",
     "pendulum: {k: 0.01, damping: 0.1, m: 0.5}\nsweep: {parameter: damping, min: 0.1, max: 0.2, count: 3, measure: "
     "[attractors]}\n",
     [["pendulum.beta=0.2", "sweep.max=0.3"]]),
    ("stability: {k: {min: 0, max: 1}, m: {min: 0, max: 1}, beta: 0.1}\n",
     "stability: {k: {min: 0, max: 1}, m: {min: 0, max: 1}, damping: 0.1}\n", [["stability.beta=0.2"]])])
def test_symbols_are_spellings_of_keys(tmp_path, by_symbol, by_name, options):
    """Q, Omega, epsilon and beta, which pictures and summaries print, in a scene and in --set."""
    for words in [[], *options]:
        changes = [word for option in words for word in ("--set", option)]
        assert resolved(tmp_path, *changes, scene=by_symbol) == resolved(tmp_path, *changes, scene=by_name)


@pytest.mark.parametrize("axis", ["sweep.x.parameter", "sweep.y.parameter", "atlas.x.parameter", "atlas.y.parameter"])
def test_a_plane_lists_only_the_keys_that_it_takes(axis):
    """A ramp changes no motion: planes refuse its keys, a sweep along a line takes them."""
    rows = [line.split(" | ") for line in (ROOT / "docs" / "reference" / "scene.md").read_text().splitlines()]
    accepted = {row[0].strip("| `"): row[1] for row in rows if len(row) > 2}
    words = accepted[axis]
    if words.startswith("as `"):  # a long text stands in the first row that has it
        words = accepted[words[4:-1]]
    assert "drive_amplitude" in words and "ramp" not in words and "ramp.periods" in accepted["sweep.parameter"]


def test_a_key_by_name_and_by_symbol_is_given_twice(tmp_path):
    pendulum = "pendulum: {Q: 5, drive_frequency: 11, drive_amplitude: 0.3, quality_factor: 5}\n"
    (tmp_path / "scene.yaml").write_text(pendulum + "attractors: {velocity: {min: -1, max: 1}}\n")
    status, _, err = program(tmp_path, "check", "scene.yaml")
    assert status == 2 and err.endswith("scene.yaml:1:61: pendulum.quality_factor: is given twice; give it once\n")


LETTERS = st.characters(exclude_categories=["Cc", "Cs", "Cn", "Co", "Zl", "Zp"], exclude_characters="\ufeff")


@SETTINGS
@given(title=st.text(LETTERS, max_size=60))
def test_titles_keep_every_letter(tmp_path, title):
    quoted = title.replace("'", "''")
    assert yaml.safe_load(resolved(tmp_path, scene=GOOD.replace("good", f"'{quoted}'")))["title"] == title


def test_windows_line_ends_are_read(tmp_path):
    assert resolved(tmp_path, scene=GOOD.replace("\n", "\r\n")) == resolved(tmp_path)


def test_whole_circle_is_the_default(tmp_path):
    theta = yaml.safe_load(resolved(tmp_path))["basin"]["theta"]
    assert theta == {"min": -math.pi, "max": math.pi, "count": 20}


NAMES = sorted(path.name for path in (ROOT / "scenes").glob("*.yaml"))


@pytest.mark.parametrize("name", with_extensive(NAMES[::8], NAMES))
def test_every_scene_of_the_repository_is_valid(tmp_path, name):
    """By the checks that come before modelling, which a time limit ends."""
    status, _, err = program(tmp_path, "run", ROOT / "scenes" / name, "--time-limit", "1e-6")
    assert status == 0 or (status == 75 and "time limit" in err), err  # some are done at once


def test_reference_of_the_keys_is_current(tmp_path):
    status, out, _ = program(tmp_path, "keys")
    assert status == 0
    assert out.decode() == (ROOT / "docs" / "reference"
                            / "scene.md").read_text(), "build/kapitza keys > docs/reference/scene.md"


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["run", "--help"], ["check", "--help"],
                                       ["keys", "--help"]])
@pytest.mark.parametrize("launcher", [[], ["mpirun", "-n", "2"]])
def test_help_and_version_are_printed_once(tmp_path, arguments, launcher):
    status, out, err = program(tmp_path, *arguments, launcher=launcher)
    assert (status, err) == (0, "")
    word = b"HDF5" if "--version" in arguments else b"Usage: kapitza"
    assert out.count(word) == 1


def test_output_that_cannot_be_written_is_a_failure():
    with open("/dev/full", "w") as full:
        done = subprocess.run([PROGRAM, "--help"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1 and "standard output" in done.stderr
