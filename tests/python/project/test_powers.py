"""What can be left out of the build stands in its own folders, and nothing else includes or calls it."""

import re
import subprocess
import sys
from functools import cache
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest
from conftest import PROGRAM, ROOT, datasets, with_extensive
from test_structure import SOURCES, edges, source_of

SPEC = spec_from_loader("ledger", SourceFileLoader("ledger", str(ROOT / "scripts" / "ledger")))
LEDGER = module_from_spec(SPEC)
SPEC.loader.exec_module(LEDGER)
powers = cache(LEDGER.powers)


def power_of(path):
    """The power that a file belongs to; None = the core."""
    for name, lists in powers().items():
        folders = [SOURCES / folder for folder in lists["FOLDERS"]]
        if any(path.is_relative_to(folder) for folder in folders) or path in [ROOT / file
                                                                              for file in lists.get("FILES", ())]:
            return name
    return None


def may_use(name):
    """The powers that one needs, and itself."""
    return {name}.union(*(may_use(need) for need in powers()[name].get("NEEDS", ()))) if name else set()


def trespasses(pairs):
    return sorted({f"{path.relative_to(ROOT)} -> {other.relative_to(ROOT)}" for path, other in pairs
                   if power_of(other) and power_of(other) not in may_use(power_of(path))})


@cache
def symbols():
    """[(source, symbol, kind)] of all objects, kind as nm prints it."""
    objects = [path for path in (PROGRAM.parent / "CMakeFiles").glob("kapitza_*.dir/src/**/*.o")
               if source_of(path).exists()]
    done = subprocess.run(["nm", "-A", "-P", *objects], capture_output=True, text=True, check=True)
    rows = [re.match(r"(.*\.o): (\S+) (\w)", line) for line in done.stdout.splitlines()]
    return [(source_of(Path(row[1])), row[2], row[3]) for row in rows if row]


def test_all_folders_of_powers_exist():
    assert len(powers()) > 1 and all(LEDGER.belongings().values())


def test_the_core_includes_no_power():
    assert not trespasses(edges())


def test_the_core_calls_no_power():
    """But for the rows by which studies, commands and the like are registered: cmake writes their names into the core's
    tables."""
    registered = {f"kz_{item}_{end}" for lists in powers().values() for kind, items in lists.items()
                  if kind not in ("FOLDERS", "FILES", "SCRIPT", "NEEDS", "BESIDE") for item in items
                  for end in ("study", "variables", "command")}
    place = {name: path for path, name, kind in symbols() if kind in "TDRBV"}
    assert len(place) > 1000
    assert not trespasses((path, place[name]) for path, name, kind in symbols()
                          if kind == "U" and name in place and name not in registered)


def test_the_core_names_no_power():
    """In no code or comment: neither what begins with the name of a power, nor its folders."""
    folders = [folder for lists in powers().values() for folder in lists["FOLDERS"] if "/" in folder]
    named = re.compile(rf"\bkz_({'|'.join(powers())})_\w+|\b({'|'.join(folders)})\b")
    texts = {path: path.read_text() for folder in (SOURCES, ROOT / "include") for path in folder.rglob("*")
             if path.suffix in {".c", ".h", ".f90", ".inc"}}
    core = {path: text for path, text in texts.items() if power_of(path) is None}
    assert len(core) > 200 and any(named.search(text) for text in texts.values())
    assert {path.name: named.search(text)[0] for path, text in core.items() if named.search(text)} == {}


@pytest.fixture(scope="session")
def core():
    """The program without powers; scripts/test has built it."""
    done = subprocess.run(["ninja", "-C", PROGRAM.parent, "trial_core"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-4000:]
    return PROGRAM.parent / "trial_core"


@pytest.mark.parametrize("scene", with_extensive(["small", "blackburn-fig05", "blackburn-fig08"],
                                                 ["blackburn-fig12", "butikov-fig01", "blackburn-walk",
                                                  "tradeoff-fig12"]))
def test_the_core_models_the_papers(core, tmp_path, scene):
    """Datasets are those of the whole program; what a clock says differs."""
    found = []
    for program in (core, PROGRAM):
        done = subprocess.run([program, "run", ROOT / "scenes" / f"{scene}.yaml", "-o",
                               tmp_path / f"{program.name}.h5"],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        found.append({name: data for name, data in datasets(tmp_path / f"{program.name}.h5").items()
                      if "seconds" not in name})
    assert found[0] == found[1]


def test_the_core_holds_no_symbol_of_a_power(core):
    known = {name for path, name, kind in symbols() if kind in "TDRBV" and power_of(path)}
    done = subprocess.run(["nm", "-P", core], capture_output=True, text=True, check=True)
    there = {line.split()[0] for line in done.stdout.splitlines()}
    assert len(known) > 300 and "kz_app_run" in there and not known & there


@pytest.mark.parametrize(("words", "told"), [
    (["check", "small", "--set", "saddles={}"], "saddles: needs the power saddles, which this build leaves out"),
    (["check", "small", "--set", "basin.proof=true"],
     "basin.proof: needs the power proof, which this build leaves out"),
    (["check", "small", "--set", "sweep={parameter: drive_amplitude, min: 0, max: 1, count: 2, measure: [share]}"],
     "other words need the power measures, which this build leaves out"),
    (["check", "small", "--set", "sweep={parameter: drive_amplitude, min: 0, max: 1, count: 2, measure: [ends]}"],
     "it needs the power ends, which this build leaves out"),
    (["check", "small", "--set", "basin.start_phase=1"],
     "basin.start_phase: needs the power release, which this build leaves out"),
    (["check", "small", "--set", "pendulum.ramp={key: damping, from: 1, periods: 2}"],
     "pendulum.ramp: needs the power release, which this build leaves out"),
    (["check", "small", "--set", "sweep={parameter: ramp.from, min: 0, max: 1, count: 2, measure: [attractors]}"],
     "other words need the power release, which this build leaves out"),
    (["check", "small", "--set", "sweep={parameter: drive_amplitude, min: 0, max: 1, count: 2, measure: [phases]}"],
     "it needs the power release, which this build leaves out"),
    (["where", "small", "0", "0"], "where: needs the power library, which this build leaves out")])
def test_what_is_missing_is_refused_by_the_name_of_its_power(core, words, told):
    words = [str(ROOT / "scenes" / "small.yaml") if word == "small" else word for word in words]
    done = subprocess.run([core, *words], capture_output=True, text=True)
    assert done.returncode == 2 and told in done.stderr


def test_the_table_of_budgets_is_kept():
    """docs/develop/developer.md: a row for the core, each power and all; what takes more than its budget says why."""
    assert not LEDGER.faults()
    done = subprocess.run([sys.executable, ROOT / "scripts" / "ledger"], capture_output=True, text=True)
    assert done.returncode == 0 and [line.split()[0]
                                     for line in done.stdout.splitlines()[1:]] == ["core", *powers(), "all"]


def test_every_line_is_counted_once():
    """The rows add up to the last, and that to what stands in the folders."""
    ledger = LEDGER.measured()
    for column, (folders, ends) in LEDGER.COLUMNS.items():
        texts = [path.read_text() for folder in folders for path in (ROOT / folder).rglob("*") if path.suffix in ends]
        parts = [amounts[column] for part, amounts in ledger.items() if part != "all"]
        assert sum(parts) == ledger["all"][column] == sum(len(text.split()) if column == "words" else text.count("\n")
                                                          for text in texts)


def test_what_exceeds_its_budget_is_told(monkeypatch):
    measured, table = LEDGER.measured(), LEDGER.budgets()
    monkeypatch.setattr(LEDGER, "budgets", lambda: table | {"atlas": (table["atlas"][0] | {"src": 100}, "")})
    assert LEDGER.faults() == [f"atlas: {measured['atlas']['src']} src exceed the budget of 100; say why"]
    monkeypatch.setattr(LEDGER, "budgets",
                        lambda: table | {"atlas": (table["atlas"][0] | {"src": 100}, "Curves are long.")})
    assert not LEDGER.faults()
    monkeypatch.setattr(LEDGER, "budgets", lambda: {part: row for part, row in table.items() if part != "atlas"})
    assert LEDGER.faults() == ["atlas is in one of power.cmake and developer.md"]
