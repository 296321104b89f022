"""What can be left out of the build stands in its own folders, and nothing else includes or calls it."""

import re
import subprocess
from functools import cache
from pathlib import Path

from conftest import PROGRAM, ROOT
from test_structure import SOURCES, edges, source_of


@cache
def powers():
    """{power: {word of kapitza_power: [its values]}} of cmake/power_list.cmake."""
    found = {}
    for name, rest in re.findall(r"^kapitza_power\((\w+)([^)]*)\)", (ROOT / "cmake" / "power_list.cmake").read_text(), re.MULTILINE):
        lists = found[name] = {}
        for word in rest.split():
            if word.isupper():
                values = lists[word] = []
            else:
                values.append(word)
    assert len(found) > 1
    return found


def power_of(path):
    """The power that a file belongs to; None = the core."""
    for name, lists in powers().items():
        folders = [SOURCES / folder for folder in lists["FOLDERS"]]
        if any(path.is_relative_to(folder) for folder in folders) or path in [ROOT / file for file in lists.get("FILES", ())]:
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
    objects = [path for path in (PROGRAM.parent / "CMakeFiles").glob("kapitza_*.dir/src/**/*.o") if source_of(path).exists()]
    done = subprocess.run(["nm", "-A", "-P", *objects], capture_output=True, text=True, check=True)
    rows = [re.match(r"(.*\.o): (\S+) (\w)", line) for line in done.stdout.splitlines()]
    return [(source_of(Path(row[1])), row[2], row[3]) for row in rows if row]


def test_all_folders_of_powers_exist():
    files = [SOURCES / folder for lists in powers().values() for folder in lists["FOLDERS"]]
    files += [ROOT / file for lists in powers().values() for file in lists.get("FILES", ())]
    assert not [path for path in files if not path.exists()]


def test_the_core_includes_no_power():
    assert not trespasses(edges())


def test_the_core_calls_no_power():
    """But for the rows by which studies, commands and the like are registered: cmake writes their names into the core's tables."""
    registered = {f"kz_{item}_{end}" for lists in powers().values() for kind, items in lists.items()
                  if kind not in ("FOLDERS", "FILES", "SCRIPT", "NEEDS") for item in items for end in ("study", "variables", "command")}
    place = {name: path for path, name, kind in symbols() if kind in "TDRBV"}
    assert len(place) > 1000
    assert not trespasses((path, place[name]) for path, name, kind in symbols()
                          if kind == "U" and name in place and name not in registered)
