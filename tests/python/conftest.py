"""Shared fixtures: a result file as the contract asks for, made without the program, and the program itself."""

import io
import itertools
import json
import os
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import h5py
import hypothesis
import matplotlib.figure
import numpy as np
import pytest
from kapitza import Result
from kapitza.command import KINDS
from kapitza.exit_status import run_script as end_script
from mpi_settings import MPI_SETTINGS

pytest.register_assert_rewrite("explorer_page")  # its fixtures are a plugin of the modules that name it
ROOT = Path(__file__).resolve().parents[2]
EXTENSIVE = bool(os.environ.get("KAPITZA_EXTENSIVE"))  # long tests run too
PROGRAM = Path(os.environ.get("KAPITZA", ROOT / "build" / "kapitza"))
TEXT = h5py.string_dtype("utf-8")
WALK = """\
title: A short walk
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.5}
sweep:
  parameter: drive_amplitude
  min: 0.46
  max: 0.48
  count: 3
  measure: [attractors, basin_fractions, phases, release_angle, strobe]
  starts: 128
  phases: 2
  transient: 20
  samples: 8
"""


def pytest_configure(config):
    """The mpirun settings of scripts/setup, for those who call pytest by hand; no example is late on a busy machine."""
    os.environ.update(MPI_SETTINGS)
    hypothesis.settings.register_profile("patient", deadline=None)
    hypothesis.settings.load_profile("patient")


def with_extensive(common, more):
    """Parameters of a test: the common ones, and those of `more` that wait for KAPITZA_EXTENSIVE=1; a tuple has several
    values."""
    rare = [row if isinstance(row, tuple) else (row,) for row in more if row not in common]
    return [*common, *(pytest.param(*row, marks=pytest.mark.extensive) for row in rare)]


def pytest_collection_modifyitems(items):
    """What takes long waits for KAPITZA_EXTENSIVE=1."""
    for item in items:
        if item.get_closest_marker("extensive") and not EXTENSIVE:
            item.add_marker(pytest.mark.skip(reason="extensive: KAPITZA_EXTENSIVE=1"))


def attractor_name(period, winding, centre):
    """The contract's name of a periodic attractor."""
    if centre == 2:
        return f"rotation {winding:+d}/{period}"
    about = ("down", "inverted", "", "wide")[centre]
    if (centre, period) == (1, 2):
        return "flutter"
    return about if period == 1 else f"{about} {period}-nodding"


def write_result(path, attractors, theta, velocity, labels, settling_time, title="", pendulum=None):
    """Writes the groups pendulum, attractors and basin. attractors: dicts of period, winding, centre, points (n, 2)."""
    count, phases = len(attractors), max(len(row["points"]) for row in attractors)
    strobe = np.full((2, count, phases), np.nan)
    for index, row in enumerate(attractors):
        strobe[:, index, : len(row["points"])] = np.transpose(row["points"])
    with h5py.File(path, "w") as file:
        file.attrs.update({"title": title, "program": "kapitza", "version": "0.4.0", "Conventions": "CF-1.8"})
        file.create_group("pendulum").attrs.update(pendulum or {"k": 1 / 121, "beta": 1 / 55, "m": 0.3})
        group = file.create_group("attractors")
        _scale(group, "attractor", np.arange(count, dtype="i4"), "id")
        _scale(group, "phase", np.arange(phases, dtype="i4"), "strobe point")
        for name in ("period", "winding"):
            _variable(group, name, [row[name] for row in attractors], "i4", ["attractor"])
        _variable(group, "centre", [row["centre"] for row in attractors], "i1", ["attractor"])
        _variable(group, "mirror", _mirrors(attractors), "i4", ["attractor"])
        names = [attractor_name(row["period"], row["winding"], row["centre"]) for row in attractors]
        _variable(group, "name", np.array(names, dtype=object), TEXT, ["attractor"])
        _variable(group, "fraction", [np.mean(labels == index) for index in range(count)], "f8", ["attractor"])
        _variable(group, "strobe_theta", strobe[0], "f8", ["attractor", "phase"])
        _variable(group, "strobe_velocity", strobe[1], "f8", ["attractor", "phase"])
        group = file.create_group("basin")
        group.attrs.update({"method": "icm", "max_periods": 2000})
        _scale(group, "velocity", velocity, "velocity")
        _scale(group, "theta", theta, "angle from down")
        _variable(group, "attractor", labels, "i2", ["velocity", "theta"])
        _variable(group, "settling_time", settling_time, "u4", ["velocity", "theta"])
        _variable(group, "evidence", np.where(labels < 0, 0, 2), "u1", ["velocity", "theta"])
        group["evidence"].attrs["flag_meanings"] = "unsettled started_inside followed integrated"


def _mirrors(attractors):
    """The id of the attractor through (-theta, -v) of each one's first point."""
    def distance(row, point):
        gap = row["points"] - point
        gap[:, 0] -= 2 * np.pi * np.rint(gap[:, 0] / (2 * np.pi))
        return np.abs(gap).sum(axis=1).min()
    images = [-np.asarray(row["points"])[0] for row in attractors]
    return [min(range(len(attractors)), key=lambda index: distance(attractors[index], image)) for image in images]


def _scale(group, name, values, long_name):
    group.create_dataset(name, data=values)
    group[name].make_scale(name)
    group[name].attrs.update({"units": "rad" if "theta" in name else "1", "long_name": long_name})


def _variable(group, name, values, dtype, dimensions):
    data = group.create_dataset(name, data=np.asarray(values, dtype=None if dtype is TEXT else dtype), dtype=dtype)
    data.attrs.update({"units": "rad" if "theta" in name else "1", "long_name": name.replace("_", " ")})
    for axis, dimension in enumerate(dimensions):
        data.dims[axis].attach_scale(group[dimension])


@pytest.fixture
def made_file(tmp_path):
    """A small result file: a circle with rotations, a mirror pair, a strobe point on the seam, and unsettled cells."""
    attractors = [
        {"period": 1, "winding": 0, "centre": 0, "points": np.array([[0.0, 0.0]])},
        {"period": 1, "winding": 0, "centre": 1, "points": np.array([[-np.pi, 0.0]])},
        {"period": 3, "winding": 0, "centre": 1, "points": np.array([[2.1, -0.1], [2.9, -0.05], [-2.8, 0.2]])},
        {"period": 3, "winding": 0, "centre": 1, "points": np.array([[2.8, -0.2], [-2.1, 0.1], [-2.9, 0.05]])},
        {"period": 1, "winding": 1, "centre": 2, "points": np.array([[3.0, 1.1]])},
        {"period": 1, "winding": -1, "centre": 2, "points": np.array([[-3.0, -1.1]])},
    ]
    theta = (2 * np.arange(60) + 1 - 60) * (np.pi / 60)
    velocity = (2 * np.arange(40) + 1 - 40) * (2 / 40)
    labels = np.fromfunction(lambda i, j: (i // 7 + j // 9) % 7 - 1, (40, 60)).astype("i2")
    path = tmp_path / "made.h5"
    write_result(path, attractors, theta, velocity, labels, np.where(labels < 0, 2000, 5), title="A made-up plane")
    return path


@pytest.fixture(scope="session")
def user_python(tmp_path_factory):
    """Runs Python as README starts it, in an environment of PATH and HOME alone: user_python("-c", TEXT, cwd=...)."""
    python, home = ROOT / ".venv" / "bin" / "python", tmp_path_factory.mktemp("home")
    own = {"PATH": os.environ["PATH"], "HOME": str(home)}
    found = subprocess.run([python, "-c", "import kapitza"], env=own, cwd=home, capture_output=True, text=True)
    assert found.returncode == 0, f"scripts/setup makes the package importable in .venv: {found.stderr}"
    return lambda *words, **more: subprocess.run([python, *map(str, words)], env=own, capture_output=True, text=True,
                                                 **more)


@pytest.fixture(scope="session")
def fig12_attractors():
    """The published attractors of Blackburn's Fig. 12, for write_result."""
    known = json.loads((ROOT / "tests" / "literature" / "reference.json").read_text())
    return [{"period": row["period"], "winding": row["winding_total"], "centre": 2 if row["winding_total"] else 0,
             "points": np.array(row["strobe_points"], dtype=float)}
            for row in known["blackburn_fig11_15_attractors_Q5_Omega11"]["0.300"]["attractors"]]


@pytest.fixture(scope="session")
def kapitza():
    """Runs the program: kapitza("run", scene, ranks=2, folder=..., check=0) -> CompletedProcess."""
    assert PROGRAM.is_file(), "build/kapitza is missing: scripts/setup builds it"

    def call(*arguments, ranks=None, folder=ROOT, status=0, text=None, launcher=None):
        command = [*(launcher or launched(ranks)), PROGRAM, *map(str, arguments)]
        done = subprocess.run(command, cwd=folder, input=text, capture_output=True, text=True)
        assert status is None or done.returncode == status, done.stderr + done.stdout
        return done

    return call


def launched(ranks, library=None, **settings):
    """What begins a command on so many ranks (None: without mpirun), with a library of tests/tools before all others
    and its settings."""
    exports = [f"LD_PRELOAD={PROGRAM.parent}/tests/{library}.so",
               *(f"KZ_{name}={value}" for name, value in settings.items())]
    return [*(["mpirun", "-n", str(ranks)] if ranks else []), *(["env", *exports] if library else [])]


def wait_for(condition, seconds=1000):
    """Waits for a condition; whether it came. What works comes much sooner, on a busy machine too."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def saved_bytes(checkpoint):
    """Bytes of finished records, nearly: those that are not 0 (room is allocated beforehand); 0 before the first
    record."""
    data = checkpoint.read_bytes() if checkpoint.exists() else b""
    marked = data[32:40] != bytes(8)  # the last word of the head
    return len(data) - data.count(0) if marked else 0


def put_scene(path, scene):
    """Writes a scene: a mapping, YAML, or the path of one."""
    path.write_text(scene.read_text() if isinstance(scene, Path) else scene if isinstance(scene, str)
                    else json.dumps(scene))


def settings(*texts):
    """Texts KEY=VALUE as options of a command."""
    return [word for text in texts for word in ("--set", text)]


def run_scene(kapitza, folder, scene, *options, ranks=None, name="s"):
    """The result of a scene, which becomes NAME.yaml of the folder, and the summary."""
    put_scene(folder / f"{name}.yaml", scene)
    done = kapitza("run", f"{name}.yaml", "--force", *options, ranks=ranks, folder=folder)
    return Result(folder / f"{name}.h5"), done.stdout


def refused_scene(kapitza, folder, scene, *options, command="run", status=2):
    """The one line of the refusal (status 2) or failure (1) of a scene, which is written; nothing else is."""
    before = {path.name for path in folder.iterdir()}
    put_scene(folder / "s.yaml", scene)
    done = kapitza(command, "s.yaml", *options, folder=folder, status=status)
    assert done.stderr.count("\n") == 1 and {path.name for path in folder.iterdir()} == before | {"s.yaml"}, done.stderr
    return done.stderr


def stopped_and_resumed(kapitza, folder, scene, ranks, *options):
    """The same by a run on one rank that is stopped once something is saved, and that `ranks` go on with."""
    put_scene(folder / "stopped.yaml", scene)
    run_until_saved(kapitza, "stopped.yaml", *options, file="stopped.h5", folder=folder, ranks=None)
    kapitza("run", "stopped.yaml", *options, "--resume", ranks=ranks, folder=folder)
    return Result(folder / "stopped.h5")


def run_until_saved(kapitza, *words, file, folder, ranks=2):
    """kapitza run WORDS, asked to stop as soon as a record of FILE's work is saved (tests/tools/stop_at.c); what it
    says to that."""
    resumed = int((folder / f"{file}.checkpoint").exists())  # whose section may have begun already
    done = kapitza("run", *words, folder=folder, status=75,
                   launcher=launched(ranks, "stop_at", WRITES=3, RESUMED=resumed))
    said = f"stopped by SIGUSR1; finished work is in {file}.checkpoint; --resume goes on from it"
    assert said in done.stderr, done.stderr
    return done.stderr


def stopped_in_each_stage(kapitza, *words, file, folder, ranks, writes=(1,)):
    """kapitza run WORDS, resumed until it is done, on `ranks` in turn; each time it is stopped in the first stage that
    is new: before its first tile (0 writes), or in the middle of its first record (1). The names of these stages."""
    found = []
    for start in itertools.count():
        launcher = launched(ranks[start % len(ranks)], "stop_at", WRITES=writes[start % len(writes)])
        done = kapitza("run", *words, *(["--resume"] if found else []), folder=folder, launcher=launcher, status=None)
        if done.returncode == 0:
            return found
        assert done.returncode == 75 and "stopped by SIGUSR1; finished work is in" in done.stderr, done.stderr
        data = (folder / f"{file}.checkpoint").read_bytes()
        found.append(data[data.rindex(b"kzstage\0") + 8:][:32].split(b"\0")[0].decode())


@pytest.fixture(scope="session")
def small_result(kapitza, tmp_path_factory):
    """The result of scenes/small.yaml on two ranks."""
    folder = tmp_path_factory.mktemp("small")
    kapitza("run", ROOT / "scenes" / "small.yaml", ranks=2, folder=folder)
    return folder / "small.h5"


@pytest.fixture(scope="session")
def swept(kapitza, tmp_path_factory):
    """The result of a short sweep with every measure but the zone of flutter."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "walk.yaml").write_text(WALK)
    kapitza("run", "walk.yaml", folder=folder)
    return folder / "walk.h5"


def datasets(path):
    """Every dataset of a file as bytes (text as it reads), by its full name."""
    contents = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            text = h5py.check_string_dtype(item.dtype)
            contents[name] = "\n".join(item.asstr()[:].ravel()) if text else (str(item.dtype), item.shape,
                                                                              item[()].tobytes())

    with h5py.File(path) as file:
        file.visititems(visit)
    return contents


def flown(field, time, start, tolerance):
    """The state after `time` of u' = field(t, u), by an integrator that shares nothing with the program: scipy's
    DOP853."""
    from scipy.integrate import solve_ivp  # loaded here: it takes a second, and few workers need it
    return solve_ivp(field, (0, time), start, method="DOP853", rtol=tolerance, atol=0.1 * tolerance).y[:, -1]


def strobed(pendulum, states, periods=1, tolerance=1e-13):
    """Angles and velocities [2, n] after whole drive periods, as flown; angles are not wrapped."""
    k, beta, m = (pendulum[name] for name in ("k", "beta", "m"))

    def field(t, u):
        theta, velocity = u.reshape(2, -1)
        return np.concatenate([velocity, -beta * velocity - (k - m * np.cos(t)) * np.sin(theta)])

    return flown(field, 2 * np.pi * periods, np.ravel(states), tolerance).reshape(2, -1)


def run_script(main, *arguments):
    """A script's main without the second that a new Python takes: its CompletedProcess."""
    output, errors, status = io.StringIO(), io.StringIO(), 0
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(output), redirect_stderr(errors):
        patch.setattr(sys, "argv", ["script", *map(str, arguments)])
        try:
            end_script(main)
        except SystemExit as end:
            status = end.code
    return subprocess.CompletedProcess(arguments, status, output.getvalue(), errors.getvalue())


def plot(kind, *arguments):
    """kapitza plot KIND with the arguments, as run_script."""
    return run_script(lambda: KINDS[kind](list(map(str, arguments))), *arguments)


@pytest.fixture
def undrawn(monkeypatch):
    """Pictures of a report are empty; test_report.py looks at drawn ones."""
    monkeypatch.setattr("kapitza.report.pictures.picture", lambda *result, **options: matplotlib.figure.Figure())


@pytest.fixture(scope="session")
def model(kapitza, tmp_path_factory):
    """model(pendulum, orbit={...} or attractors={...}) -> Result."""
    folder = tmp_path_factory.mktemp("orbits")
    made = {}

    def call(pendulum, **studies):
        text = json.dumps({"pendulum": pendulum, **studies})
        if text not in made:
            scene = folder / f"{len(made)}.yaml"
            scene.write_text(text)
            kapitza("run", scene, "-o", scene.with_suffix(".h5"))
            made[text] = Result(scene.with_suffix(".h5"))
        return made[text]

    return call
