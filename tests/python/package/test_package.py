"""The Python package: what `pip install .` gives, what type checker and linter say of it, its panels on anybody's Axes,
and files of every kind whose variables or attributes are missing or wrong."""

import importlib
import inspect
import pkgutil
import shutil
import subprocess
import sys
import tarfile

import h5py
import numpy as np
import pytest
from conftest import PROGRAM, ROOT, plot, with_extensive
from kapitza import Result, plots, style
from kapitza.plots.basin import draw_basins, draw_evidence, draw_one, draw_settling_time
from kapitza.plots.orbit_panels import draw_path, draw_phase, draw_spectrum
from kapitza.plots.orbit_record import Orbit
from kapitza.plots.orbit_time import draw_time
from matplotlib.axes import Axes
from matplotlib.figure import Figure

SCENES = {
    "orbit": "pendulum: {k: 0.1, damping: 0.2, m: 0.1}\norbit: {start: {theta: 1, velocity: 0}, periods: 5}\n",
    "stability": "stability: {k: {min: -0.5, max: 1, count: 7}, m: {min: 0, max: 1, count: 5}, damping: 0.05,"
                 " curves: [exact_1, damped_1, butikov_1], subharmonics: [2]}\n",
    "potential": "pendulum: {k: 0.01, damping: 0.2, m: 0.3}\npotential: {drive_amplitudes: [0.2, 0.3], theta: {count: "
                 "9}}\n",
}


def python(*arguments, **more):
    return subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, **more)


@pytest.fixture(scope="module")
def results(kapitza, swept, tmp_path_factory):
    """kind -> a small result of it."""
    folder = tmp_path_factory.mktemp("kinds")
    for kind, scene in SCENES.items():
        (folder / f"{kind}.yaml").write_text(scene)
        kapitza("run", f"{kind}.yaml", folder=folder)
    return {kind: folder / f"{kind}.h5" for kind in SCENES} | {"sweep": swept}


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    """The sources as pip would get them, in one archive."""
    folder = tmp_path_factory.mktemp("sdist")
    make = f"from scikit_build_core.build import build_sdist; print(build_sdist({str(folder)!r}))"
    done = python("-c", make, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return folder / done.stdout.split()[-1]


@pytest.mark.extensive
def test_the_sdist_has_all_that_a_build_needs(sdist):
    """Every file under version control but those of the repository itself."""
    parts = "CMakeLists.txt cmake include src python web scenes LICENSE README.md".split()
    tracked = subprocess.run(["git", "ls-files", *parts], cwd=ROOT, capture_output=True, text=True,
                             check=True).stdout.split()
    with tarfile.open(sdist) as archive:
        held = {name.split("/", 1)[-1] for name in archive.getnames()}
    assert len(tracked) > 300 and not set(tracked) - held


@pytest.mark.extensive
def test_a_fresh_environment_builds_and_runs_an_example():
    done = subprocess.run([ROOT / "scripts" / "test_install"], capture_output=True, text=True)
    assert done.returncode == 0 and "rotation +1/1" in done.stdout and done.stdout.endswith("small.png\n"), done.stderr


@pytest.mark.parametrize("words, status", with_extensive([([], 2)], [(["portrait", "FILE"], 2), (["--help"], 0)]))
def test_the_command_names_its_kinds(words, status):
    done = python("-c", "from kapitza.command import main; main()", *words)
    assert done.returncode == status and "KIND: atlas, basin, compare" in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("tool", [pytest.param(["mypy"], marks=pytest.mark.extensive), ["ruff", "check"]])
def test_checkers_find_nothing(tool):
    done = python("-m", *tool, cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def panels():
    """Every draw_* function of the modules of kapitza.plots."""
    modules = [importlib.import_module(f"kapitza.plots.{module.name}")
               for module in pkgutil.iter_modules(plots.__path__)]
    return {function for module in modules for name, function in vars(module).items() if name.startswith("draw_")
            and callable(function)}


def test_every_panel_takes_and_returns_an_axes():
    found = panels()
    assert len(found) > 20
    for function in found:
        signature = inspect.signature(function)
        first = next(iter(signature.parameters.values()))
        assert (first.name, first.annotation, signature.return_annotation) == ("axes", Axes, Axes), function
        assert {"colour" if function is draw_one else "colours", "legend"} <= signature.parameters.keys(), function


@pytest.mark.extensive
def test_panels_keep_to_their_axes(made_file, results):
    """On one figure of somebody else: the same Axes comes back, its neighbours stay empty, and without a legend there
    is none."""
    result, orbit = Result(made_file), Orbit(Result(results["orbit"]))
    basin, attractors = result.group("basin"), result.group("attractors")
    calls = [(draw_basins, basin, attractors), (draw_one, basin, attractors, [1]), (draw_settling_time, basin),
             (draw_evidence, basin),
             (draw_time, orbit), (draw_path, orbit), (draw_phase, orbit), (draw_spectrum, orbit)]
    for function, *data in calls:
        mine, other = Figure().subplots(1, 2)
        assert function(mine, *data, legend=False) is mine and mine.has_data()
        assert mine.get_legend() is None and not other.has_data() and len(mine.figure.axes) == 2


def test_colours_are_arguments(made_file):
    result = Result(made_file)
    axes = draw_basins(Figure().subplots(), result.group("basin"), result.group("attractors"), dots=False,
                       colours=["#102030", "#405060", "#708090", "#a0b0c0", "#d0e0f0", "#010203"])
    image, labels = axes.images[0].get_array(), result.group("basin")["attractor"].values
    assert np.allclose(image[labels == 2], np.array([0x70, 0x80, 0x90]) / 255) and np.allclose(image[labels < 0], 1)
    assert style.UNSETTLED == "#ffffff"


def test_a_group_belongs_to_who_has_read_it(made_file):
    """A change of it, in values, attributes or variables, does not come back with the next one."""
    result = Result(made_file)
    for _ in range(2):
        basin = result.group("basin")
        assert basin["attractor"].values.min() == -1 and "mine" not in basin.attrs
        basin["attractor"].values[:] = 7
        basin.attrs["mine"], basin["further"] = 1, basin["theta"]
    assert "further" not in result.group("basin")


def craft(file, group, name, how):
    """Spoils a variable or an attribute of the group."""
    if name in file[group].attrs:
        attributes = file[group].attrs
        if how == "missing":
            del attributes[name]
        else:
            attributes[name] = {"text": "x", "short": np.zeros(3), "not finite": np.nan, "huge": 1e300}[how]
        return
    values = file[group][name][()]
    if how in ("not finite", "huge"):
        if values.dtype.kind == "f":
            file[group][name][...] = np.nan if how == "not finite" else 1e300
        return
    del file[group][name]
    if how == "text":
        file[group].create_dataset(name, data=np.full(values.shape, "x", dtype=object), dtype=h5py.string_dtype())
    elif how == "short":
        file[group][name] = np.zeros(1)


@pytest.mark.parametrize("kind, name, how, words", [
    ("sweep", "fraction_low", "missing", "incomplete, the group sweep lacks fraction_low"),
    ("sweep", "fraction_high", "short", "sweep/fraction_high is not over value and branch"),
    ("sweep", "branch_mirror", "missing", "lacks branch_mirror"),
    ("sweep", "branch_name", "short", "branch_name is not over branch"),
    ("sweep", "phases", "text", "the attribute phases of sweep is of another type"),
    ("sweep", "phases", "missing", "lacks phases"),
    ("orbit", "line_amplitude", "text", "line_amplitude is of another type"),
    ("orbit", "period", "text", "the attribute period of orbit is of another type"),
    ("stability", "stable", "short", "stability/stable is not over m and k"),
    ("stability", "damping", "text", "the attribute damping of stability is of another type"),
    ("stability", "exact_1", "text", "exact_1 is of another type"),
    ("potential", "rim_exact", "missing", "lacks rim_exact"),
])
def test_what_is_missing_or_wrong_is_named(results, tmp_path, kind, name, how, words):
    path = shutil.copy(results[kind], tmp_path / "crafted.h5")
    with h5py.File(path, "r+") as file:
        craft(file, kind, name, how)
    done = plot(kind, path, "-o", tmp_path / "out.png")
    assert done.returncode == 1 and done.stderr.startswith(
        f"kapitza: error: {path}: ") and words in done.stderr, done.stderr
    assert not (tmp_path / "out.png").exists()


def test_an_import_loads_no_library(user_python):
    """pandas, xarray and their like are loaded by the first name that needs them; names, modules and the version are
    there."""
    script = """import sys, kapitza
heavy = {"pandas", "xarray", "numpy", "matplotlib", "h5py", "h5netcdf", "scipy", "yaml", "tqdm", "PIL"}
heavy &= set(sys.modules)
assert not heavy and sum(name.startswith("kapitza") for name in sys.modules) == 1, heavy
assert set(kapitza.__all__) <= set(dir(kapitza)) and not hasattr(kapitza, "nonsense")
assert all(callable(getattr(kapitza, name)) for name in kapitza.__all__)
assert kapitza.plots.__doc__ and kapitza.style.KINDS
print(kapitza.__version__)"""
    done = user_python("-c", script)
    version = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    assert (done.returncode, done.stdout.strip()) == (0, version), done.stderr
