"""Scenes and command lines that must be refused: exit 2, one line that names the key, nothing written."""

import os
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import PROGRAM

GOOD = """\
title: good
pendulum:
  quality_factor: 5
  drive_frequency: 11
  drive_amplitude: 0.3
basin:
  theta: {count: 20}
  velocity: {min: -2, max: 2, count: 20}
"""
SI = ("pendulum: {mass: 1, radius: 1, inertia: 1, friction: 0.2, gravity: 1, pivot_amplitude: 0.3, pivot_frequency: "
      "11}\n")
BASIN = "basin: {velocity: {min: -2, max: 2}}\n"


def program(folder, *arguments, launcher=()):
    done = subprocess.run([*launcher, PROGRAM, *arguments], cwd=folder, capture_output=True)
    return done.returncode, done.stdout, done.stderr.decode("utf-8", "replace")


def contents(folder):
    return {path: path.stat().st_mtime_ns for path in sorted(folder.rglob("*"))}


def refused(folder, *arguments):
    """The one line of a refusal, after looking that nothing else came of it."""
    before = contents(folder)
    status, out, err = program(folder, *arguments)
    assert (status, out) == (2, b""), err
    assert contents(folder) == before
    assert err.endswith("\n") and err[:-1].isprintable(), err
    assert err.startswith("kapitza: error: ")
    return err


def replaced(old, new):
    assert old in GOOD
    return GOOD.replace(old, new)


# Text of the scene; where the error stands; what the line must name. The reading itself is tested in
# tests/unit/app/scene.c.
SCENES = {
    "unknown nested key": (GOOD + "  colour: red\n", "9:3",
        "basin.colour: unknown key; the keys are theta, velocity, method"),
    "sweep of a key of another form": (GOOD + "sweep: {parameter: m, min: 0, max: 1, count: 3, measure: [strobe]}\n",
        "9:20", "sweep.parameter: m is not given in the pendulum mapping"),
    "sweep out of the key's range": (
        GOOD + "sweep: {parameter: drive_frequency, min: -1, max: 1, count: 3, measure: [strobe]}\n",
        "9:42", "sweep.min: -1 is below what pendulum.drive_frequency takes"),
    "sweep of an angle in mm": (GOOD.replace("pendulum:\n", "pendulum:\n  tilt: 0\n", 1)
        + "sweep: {parameter: tilt, min: 1°, max: 6 mm, count: 3, measure: [strobe]}\n",
        "10:40", "sweep.max: \"6 mm\" is not a finite decimal number; it must be a number in rad"),
    "sweep of nothing": (GOOD
                         + "sweep: {parameter: drive_amplitude, min: 0.2, max: 0.2, count: 3, measure: [strobe]}\n",
        "9:52", "sweep.max: 0.2 is too small; it must be"),
    "saddles without velocities": (GOOD + "saddles: {max_period: 3}\n", "9:10", "saddles.velocity: is missing"),
    "saddles of a long period": (GOOD + "saddles: {velocity: {min: -1, max: 1}, max_period: 33}\n", "9:52",
                                 "saddles.max_period"),
    "saddles of an empty window": (GOOD + "saddles: {velocity: {min: 1, max: 1}}\n", "9:35",
                                   "saddles.velocity.max: 1 is too small"),
    "former study": (GOOD + "manifolds: {kind: stable}\n", "9:1",
                     "is no longer a key; use kapitza.manifolds(...) in Python"),
    "plane of one key": (
        GOOD + "sweep: {x: {parameter: drive_amplitude, min: 0, max: 1, count: 2}, y: {parameter: drive_amplitude, "
        "min: 0, max: 1, count: 2}, measure: [ends], ends: {theta: [1]}}\n", "9:83",
        "sweep.y.parameter: is also the parameter of"),
    "plane of a key of another form": (
        GOOD + "sweep: {x: {parameter: k, min: 0, max: 1, count: 2}, y: {parameter: m, min: 0, "
        "max: 1, count: 2}, measure: [ends], ends: {theta: [1]}}\n", "9:24",
        "sweep.x.parameter: k is not given in the pendulum"),
    "plane with velocities for other angles": (GOOD
                                               + "sweep: {x: {parameter: drive_frequency, min: 2, max: 3, count: 2}, "
        "y: {parameter: drive_amplitude, min: 0, max: 1, count: 2}, measure: [ends], ends: {theta: [1, 2, 3], "
        "velocity: [0, 1]}}\n",
        "", "sweep.ends.velocity: has another number of values than theta"),
    "the study that is a measure now": (GOOD + "chart: {x: {parameter: drive_frequency, min: 2, max: 3}}\n",
        "9:1", "chart: is no longer a key; use sweep.measure ends"),
    "plane of what goes along a line": (GOOD + "sweep: {x: {parameter: drive_frequency, min: 2, max: 3, count: 2}, "
        "y: {parameter: drive_amplitude, min: 0, max: 1, count: 2}, measure: [strobe]}\n", "",
        "give parameter, min, max and count"),
    "plane of an unknown word": (GOOD + "sweep: {x: {parameter: drive_frequency, min: 2, max: 3, count: 2}, "
        "y: {parameter: drive_amplitude, min: 0, max: 1, count: 2}, measure: [endings]}\n", "",
        'sweep.measure: "endings" is unknown'),
    "line of ends": (GOOD + "sweep: {parameter: drive_frequency, min: 2, max: 3, count: 2, measure: [ends], ends: "
                            "{theta: [1]}}\n", "",
        "give x and y"),
    "plane without ends": (GOOD + "sweep: {x: {parameter: drive_frequency, min: 2, max: 3, count: 2}, "
        "y: {parameter: drive_amplitude, min: 0, max: 1, count: 2}, measure: [ends]}\n", "", "sweep.ends: is missing"),
    "measure twice": (GOOD + "measures: {names: [share, share], velocity: {min: -1, max: 1}}\n", "",
                      "measures.names: has a word twice"),
    "escape without saddles": (GOOD + "escape: {}\n", "9:9", "escape: needs a list of unstable cycles"),
    "escape without damping": ("pendulum: {k: 0, damping: 0, m: 0.3}\nattractors: {velocity: {min: -1, max: 1}}\n"
        "saddles: {velocity: {min: -1, max: 1}}\nescape: {}\n", "4:9", "escape: needs damping"),
    "edge, which escape replaces": (GOOD + "edge: {}\n", "9:1", "edge: is no longer a key; use escape"),
    "shocks whose sizes go down": (GOOD + "  shocks: {sizes: [1, 0.5]}\n", "9:19",
                                   "basin.shocks.sizes: has a size that is not above"),
    "sweep without a measure": (GOOD + "sweep: {parameter: drive_amplitude, min: 0, max: 0.5, count: 3, measure: []}\n",
        "9:74", "sweep.measure"),
    "sweep with an unknown measure": (
        GOOD + "sweep: {parameter: drive_amplitude, min: 0, max: 0.5, count: 3, measure: [angle]}\n",
        "9:75", "sweep.measure"),
    "sweep with a measure that is no list": (
        GOOD + "sweep: {parameter: drive_amplitude, min: 0, max: 0.5, count: 3, measure: strobe}\n", "9:74",
        "(did you mean [strobe]?)"),
    "sweep of one value": (GOOD
                           + "sweep: {parameter: drive_amplitude, min: 0, max: 0.5, count: 1, measure: [strobe]}\n",
        "9:62", "sweep.count"),
    "case of a key": (replaced("title", "Title"), "1:1", "Title: unknown key; did you mean title?"),
    "former flag": (GOOD + "  flag_undecided: true\n", "9:3",
                    "basin.flag_undecided: is no longer a key; use basin.method exact"),
    "decisions without the method": (GOOD + "  method: icm\n  undecided: decide\n", "10:14",
        "basin.undecided: decide needs basin.method: exact; choose that method, or flag"),
    "former precision": (GOOD + "numerics: {precision: quad}\n", "9:12", "basin.method exact"),
    "former interpolation": (GOOD.replace("basin:", "basin:\n  icm: {interpolation: cubic}"), "", "quintic"),
    "decimal comma": (replaced("amplitude: 0.3", "amplitude: 0,3"), "5:20", "(with a decimal point: 0.3)"),
    "quoted number": (replaced("amplitude: 0.3", "amplitude: '0.3'"), "5:20", "stands in quotes"),
    "empty value": (replaced("amplitude: 0.3", "amplitude:"), "", "pendulum.drive_amplitude: the value is empty"),
    "list for a number": (replaced("amplitude: 0.3", "amplitude: [0.3]"), "5:20",
                          "pendulum.drive_amplitude: the value is a list"),
    "number for a mapping": (replaced("theta: {count: 20}", "theta: 20"), "7:10", "basin.theta"),
    "empty mapping": (replaced("theta: {count: 20}", "theta:"), "", "basin.theta: the value is empty"),
    "title of two lines": (replaced("title: good", 'title: "a\\nb"'), "1:8", "title"),
    "huge count": (replaced("theta: {count: 20}", "theta: {count: 1000001}"), "7:18", "from 1 to 1000000"),
    "counts beyond memory": (replaced("count: 20", "count: 1000000"), "", "memory"),
    "table beyond memory": (GOOD + "  method: icm\n  icm: {theta: 100000, velocity: 100000}\n", "", "memory"),
    "table too small": (GOOD + "  icm: {theta: 7}\n", "9:16", "basin.icm.theta"),
    "period too long": (GOOD + "  attractors: {max_period: 513}\n", "9:28", "basin.attractors.max_period"),
    "too many periods": (GOOD + "  max_periods: 5000000000\n", "9:16", "basin.max_periods"),
    "too many steps": (GOOD + "numerics: {steps_per_period: 100001}\n", "9:30", "numerics.steps_per_period"),
    "velocity without max": (replaced("min: -2, max: 2", "min: -2"), "8:13", "basin.velocity.max: is missing"),
    "window by centre and edge": (replaced("min: -2, max: 2", "centre: 0, max: 2"), "8:25",
        "basin.velocity.max: contradicts basin.velocity.centre"),
    "centre alone": (replaced("min: -2, max: 2", "centre: 0"), "8:13", "basin.velocity.width: is missing"),
    "angle by width alone": (replaced("theta: {count", "theta: {width: 1, count"), "7:10",
                             "basin.theta.centre: is missing beside width"),
    "window that is too wide": (replaced("theta: {count", "theta: {centre: 0, width: 6.3, count"), "7:29",
        "basin.theta.width: 6.3 is too wide"),
    "cells too narrow for the method": (replaced("min: -2, max: 2", "centre: 1, width: 1e-15") + "  method: direct\n",
                                        "8:32",
        "basin.velocity.width: 1e-15 leaves cells of width 5e-17, too narrow for double precision; choose "
        "basin.method exact"),
    "theta wider than a turn": (replaced("theta: {count", "theta: {min: -4, max: 4, count"), "7:25", "at most 2 pi"),
    "cells too narrow": (replaced("min: -2, max: 2", "min: 1, max: 1.0000000000000009"), "8:27", "too narrow"),
    "no velocity": ("pendulum: {k: 0, damping: 0.1, m: 0.5}\nbasin: {}\n", "2:8", "basin.velocity: is missing"),
    "no pendulum": (BASIN, "1:1", "pendulum: is missing"),
    "no study": ("pendulum: {k: 0, damping: 0.1, m: 0.5}\n", "1:1", "basin"),
    "no parameters": ("pendulum: {}\n" + BASIN, "1:11", "also missing: pendulum.drive_amplitude"),
    "half of form a": ("pendulum: {drive_frequency: 11}\n" + BASIN, "1:11", "pendulum.drive_amplitude: is missing"),
    "half of form c": ("pendulum: {mass: 1, radius: 1}\n" + BASIN, "1:11",
        "the pendulum lacks: inertia; frequency (in Hz; or pivot_frequency in rad/s); amplitude (of the pivot); "
        "quality_factor (or"),
    "half of a laboratory": ("pendulum: {length: 20 cm, friction: 0.1}\n" + BASIN, "1:11",
        "lacks: mass (beside friction or a torque); frequency"),
    "unit of another quantity": ("pendulum: {length: 2 Hz}\n" + BASIN, "1:20",
                                 'pendulum.length: "2 Hz" is in a unit of another quantity'),
    "unknown unit": ("pendulum: {length: 1 ell}\n" + BASIN, "1:20", "in m, or with its unit: cm, mm"),
    "damping twice": ("pendulum: {length: 1, decay_time: 1 s, quality_factor: 3}\n" + BASIN, "1:35",
        "pendulum.decay_time: contradicts quality_factor"),
    "no pendulum for the second study": (
        "stability: {k: {min: 0, max: 1}, m: {min: 0, max: 1}}\norbit: {start: {theta: 0, velocity: 0}}\n",
        "1:1", "pendulum: is missing"),
    "inertia of no body": (SI.replace("inertia: 1,", "inertia: 0.999,") + BASIN, "1:41",
        "pendulum.inertia: 0.999 is below pendulum.mass * pendulum.radius^2 = 1"),
    "sweep to the inertia of no body": (
        SI + "sweep: {parameter: radius, min: 0.5, max: 1.1, count: 3, measure: [strobe]}\n", "2:43",
        "sweep.max: 1.1 gives"),
    "zero frequency": (replaced("frequency: 11", "frequency: 0"), "4:20", "pendulum.drive_frequency"),
    "k overflows": (replaced("frequency: 11", "frequency: 1e-200"), "3:3", "pendulum: gives k = inf"),
    "merge key": ("<<: {title: x}\n" + GOOD, "1:1", "<<: unknown key"),
    "list as a key": ("? [a, b]\n: 1\n", "1:3", "unknown key"),
    "text as the scene": ("just words\n", "1:1", "scene: "),
    "bracket left open": (replaced("{count: 20}\n", "{count: 20\n"), "", "is not YAML"),
    "bad indentation": (replaced("  drive_frequency", " drive_frequency"), "5:18", "is not YAML"),
    "tab": (replaced("  drive_frequency", "\tdrive_frequency"), "4:1", "a tab stands here"),
    "binary file": (b"\x89HDF\r\n\x1a\n\0\0\0\0", "", "is a result, not a scene"),
    "nul byte": (GOOD.encode() + b"a: \0\n", "9:4", "is not text"),
    "UTF-16": (GOOD.encode("utf-16"), "1:1", "is not text"),
    "C1 control in the title": (replaced("title: good", r'title: "red \x9b31m"'), "1:8",
                                "holds a line break or a control"),
    "C1 control in a key": (GOOD + r'"a\x9bb": 1' + "\n", "9:1", "a?b: unknown key"),
    "byte-order mark": (b"\xef\xbb\xbf" + GOOD.encode(), "1:1", "byte-order mark"),
    "too large": (GOOD + "#" * 1_000_000, "", "a scene has at most that many"),
}


# Arguments after `kapitza`; what the line must name
COMMAND_LINES = {
    "nothing": ([], "no command"),
    "unknown command": (["modl", "scene.yaml"], "modl"),
    "typo in a command": (["chekc", "scene.yaml"], "did you mean check?"),
    "no scene": (["run"], "SCENE is missing"),
    "decimal comma of a start": (["where", "scene.yaml", "3,1", "0"], "(with a decimal point: 3.1)"),
    "two scenes": (["run", "scene.yaml", "scene.yaml"], "one argument too many"),
    "missing scene": (["run", "absent.yaml"], "absent.yaml: cannot be opened"),
    "folder as the scene": (["run", "folder"], "folder: is a folder"),
    "device as the scene": (["run", "/dev/null"], "/dev/null: is not a regular file"),
    "scene below a file": (["run", "scene.yaml/x"], "scene.yaml/x: cannot be opened"),
    "unknown option": (["run", "scene.yaml", "--colour"], "--colour: unknown option"),
    "typo in an option": (["run", "scene.yaml", "--resmue"], "did you mean --resume?"),
    "option without value": (["run", "scene.yaml", "--set"], "--set: needs a value"),
    "key without its mapping": (["check", "scene.yaml", "--set", "drive_amplitude=.4"],
                                "did you mean pendulum.drive_amplitude?"),
    "option of another command": (["check", "scene.yaml", "--force"], "--force: unknown option"),
    "resume and force": (["run", "scene.yaml", "--resume", "--force"], "--resume: contradicts --force"),
    "progress": (["run", "scene.yaml", "--progress", "maybe"], "--progress"),
    "time limit of words": (["run", "scene.yaml", "--time-limit", "soon"], "--time-limit"),
    "missing folder": (["run", "scene.yaml", "-o", "absent/x.h5"], "absent/x.h5: the folder absent"),
    "file as the folder": (["run", "scene.yaml", "-o", "scene.yaml/x.h5"], "scene.yaml is a file"),
    "name too long": (["run", "scene.yaml", "-o", "x" * 300], "File name too long"),
    "path too long": (["run", "scene.yaml", "-o", "x/" * 3000], "too long"),
    "read-only folder": (["run", "scene.yaml", "-o", "/proc/x.h5"], "/proc/x.h5"),
    "existing output": (["run", "scene.yaml", "-o", "there.h5"], "there.h5: exists; use --force"),
    "resume into another file": (["run", "scene.yaml", "-o", "there.h5", "--resume"],
                                 "there.h5: exists and is no file of this program"),
    "existing checkpoint": (["run", "scene.yaml", "-o", "half.h5"], "half.h5.checkpoint"),
    "checkpoint of another program": (["run", "scene.yaml", "-o", "half.h5", "--resume"], "half.h5.checkpoint"),
    "scene as the output": (["run", "scene.yaml", "-o", "scene.yaml", "--force"], "scene.yaml: is the scene itself"),
    "set of two words": (["run", "scene.yaml", "--set", "basin.theta.count", "20"], "write --set basin.theta.count=20"),
    "set without value": (["run", "scene.yaml", "--set", "basin.theta.count"],
                          "--set basin.theta.count: is not KEY=VALUE"),
    "set out of range": (["run", "scene.yaml", "--set", "basin.theta.count=0"],
                         "--set basin.theta.count=0: basin.theta.count"),
    "set to an open bracket": (["run", "scene.yaml", "--set", "basin.theta={count: 3"], "is not YAML"),
    "method that was removed": (["check", "scene.yaml", "--set", "basin.method=hybrid"], "use direct"),
    "tolerance of nothing": (["check", "scene.yaml", "--set", "numerics.tolerance=0"], "numerics.tolerance"),
    "steps of words": (["check", "scene.yaml", "--set", "numerics.steps_per_period=many"], "from 1 to 100000, or auto"),
    "title that turns the terminal round": (["check", "scene.yaml", "--set", 'title="a \u202e b"'],
                                            "holds a line break or a control"),
    "set that contradicts": (["run", "scene.yaml", "--set", "pendulum.k=1"],
                             "--set pendulum.k=1: pendulum.k: contradicts"),
    "set inside a replaced mapping": (["run", "scene.yaml", "--set", "basin.velocity={min: 0, mx: 1}"],
                                      "basin.velocity.mx"),
}


def refuse_command_line(folder, name):
    (folder / "scene.yaml").write_text(GOOD)
    (folder / "folder").mkdir()
    (folder / "there.h5").write_text("here already")
    (folder / "half.h5.checkpoint").write_text("begun")
    return refused(folder, *COMMAND_LINES[name][0])


@pytest.fixture(scope="module")
def refusals(tmp_path_factory):
    """All of them side by side, since starting MPI is mostly waiting: name -> the line, once it is asked for."""
    with ThreadPoolExecutor(8) as pool:
        lines = {name: pool.submit(refuse_command_line, tmp_path_factory.mktemp("line"), name)
                 for name in COMMAND_LINES}
        lines |= {name: pool.submit(refuse_scene, tmp_path_factory.mktemp("scene"), "check", name) for name in SCENES}
        return lines


def refuse_scene(folder, command, name):
    text = SCENES[name][0]
    (folder / "scene.yaml").write_bytes(text if isinstance(text, bytes) else text.encode())
    return refused(folder, command, "scene.yaml")


@pytest.mark.parametrize("name", SCENES)
def test_scene_is_refused(refusals, name):
    line = refusals[name].result()
    _, place, named = SCENES[name]
    assert named in line
    if place:
        assert line.startswith(f"kapitza: error: scene.yaml:{place}")


@pytest.mark.parametrize("name", COMMAND_LINES)
def test_command_line_is_refused(refusals, name):
    assert COMMAND_LINES[name][1] in refusals[name].result()


def test_unwritable_folder(tmp_path):
    if os.geteuid() == 0:
        pytest.skip("the superuser may write everywhere")
    (tmp_path / "scene.yaml").write_text(GOOD)
    tmp_path.chmod(0o500)
    assert "cannot be written" in refused(tmp_path, "run", "scene.yaml")


@pytest.mark.parametrize("arguments", [["run", "scene.yaml"], ["run", "--colour"], ["check", "scene.yaml"]])
def test_one_line_under_mpirun(tmp_path, arguments):
    (tmp_path / "scene.yaml").write_text(GOOD + "colour: red\n")
    status, _, err = program(tmp_path, *arguments, launcher=["mpirun", "-n", "2"])
    lines = [line for line in err.splitlines() if "kapitza" in line]
    assert status == 2 and len(lines) == 1 and "colour: unknown" in lines[0], err
