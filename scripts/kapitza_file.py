"""The one reader of kapitza's result files (HDF5, netCDF-4 readable).

>>> result = Result("blackburn-fig12.h5")
>>> basin = result.group("basin")           # an xarray.Dataset, in memory
>>> result.pendulum["k"], result.attributes["title"]
"""

import os
import sys
from pathlib import Path

import h5py
import numpy as np
import xarray

# Variables without which a group is of no use to any script, with their dimensions; the study that writes a group adds its rows here.
NEEDED = {
    "attractors": {**dict.fromkeys(["period", "winding", "centre", "name", "mirror"], "attractor"),
                   **dict.fromkeys(["strobe_theta", "strobe_velocity"], "attractor phase")},
    "orbit": {**dict.fromkeys(["time", "theta", "velocity", "pivot"], "time"),
              **dict.fromkeys(["strobe_time", "strobe_theta", "strobe_velocity"], "strobe_time"),
              **dict.fromkeys(["maximum_time", "maximum_angle"], "maximum_time"),
              **dict.fromkeys(["line_frequency", "line_amplitude", "line_phase"], "line_frequency")},
    "stability": {"k": "k", "m": "m", **dict.fromkeys(["log_multiplier", "angle", "stable"], "m k")},
    "potential": {"theta": "theta", "drive_amplitude": "drive_amplitude", "rim_exact": "drive_amplitude",
                  **dict.fromkeys(["energy", "energy_blackburn", "energy_simple"], "drive_amplitude theta")},
    "tradeoff": dict.fromkeys(["label", "method", "precision", "scheme", "interpolation", "wrong", "wrong_low", "wrong_high", "seconds",
                               "seconds_per_million_cells", "pareto"], "setting"),
    "basin": {"theta": "theta", "velocity": "velocity",
              **dict.fromkeys(["attractor", "settling_time", "evidence"], "velocity theta")},
    "sweep": {"value": "value"},
}
# Attributes of a group that the scripts need.
NEEDED_ATTRIBUTES = {"orbit": ["closed", "centre", "period", "winding"], "sweep": ["parameter"], "tradeoff": ["floor", "samples"]}
# What is not a number, and what counts or is a code (with the largest code, where there is one).
TEXT = {"name", "label", "scheme", "branch_name"}
CODES = {"period": None, "centre": 3, "evidence": 4, "settling_time": None, "method": 2, "precision": 2, "interpolation": 2,
         "branch_period": None, "branch_centre": 3}
GRIDS = {"theta", "velocity", "time", "k", "m", "value"}  # axes that go up


class BadFile(Exception):
    """A file that cannot be used; the text says which and why, in one line."""


class Result:
    """A complete result file of kapitza."""

    def __init__(self, path):
        self.path = Path(path)
        self.attributes, self.groups, self.pendulum = self._open()

    def _open(self):
        if not self.path.is_file():
            raise BadFile(f"{self.path}: {'not a file' if self.path.exists() else 'no such file'}")
        try:
            with h5py.File(self.path, "r") as file:
                groups = [name for name in file if file.get(name, getclass=True, getlink=True) is h5py.HardLink
                          and isinstance(file[name], h5py.Group)]
                attributes, pendulum = _attributes(file), _attributes(file["pendulum"]) if "pendulum" in groups else {}
        except OSError as error:
            reason = "truncated" if "truncated" in str(error) else "not an HDF5 file, or damaged"
            raise BadFile(f"{self.path}: {reason}") from error
        except (KeyError, RuntimeError, ValueError) as error:
            raise BadFile(f"{self.path}: damaged") from error
        if attributes.get("program") != "kapitza":
            raise BadFile(f"{self.path}: not a result of kapitza")
        if "pendulum" in groups and not all(isinstance(pendulum.get(name), int | float) for name in ("k", "beta", "m")):
            raise BadFile(f"{self.path}: incomplete, the group pendulum lacks k, beta or m")
        return attributes, groups, pendulum

    def group(self, name):
        """The group as an xarray.Dataset, read whole."""
        if name not in self.groups:
            held = ", ".join(group for group in self.groups if group != "pendulum") or "none"
            raise BadFile(f"{self.path}: holds no {name} (studies in it: {held})")
        try:
            wrong = self._unreadable(name)
            if not wrong:
                with xarray.open_dataset(self.path, group=name, engine="h5netcdf", phony_dims="sort") as dataset:
                    dataset = dataset.load()
        except Exception as error:  # h5py and h5netcdf raise many kinds for one cause: the bytes are damaged
            raise BadFile(f"{self.path}: damaged in the group {name}") from error
        wrong = wrong or _lacking(dataset, name) or next(filter(None, (_fault(dataset, variable) for variable in dataset.variables)), None)
        if wrong:
            raise BadFile(f"{self.path}: {wrong}")
        return dataset

    def _unreadable(self, name):
        """Why a group is not read: data outside this file, or more than a picture of it could be made from."""
        with h5py.File(self.path, "r") as file:
            links = [file[name].get(variable, getlink=True) for variable in file[name]]
            items = [] if any(isinstance(link, h5py.ExternalLink) for link in links) else [file[name][variable] for variable in file[name]]
            if len(items) < len(links) or any(getattr(item, "external", None) or getattr(item, "is_virtual", False) for item in items):
                return f"the group {name} keeps data in another file"
            size, memory = sum(item.nbytes for item in items), os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        if 8 * size > memory:  # what reading and drawing it takes
            return f"the group {name} holds {size / 1e9:.3g} GB, too much for a picture with {memory / 1e9:.3g} GB of memory"
        return None


def _lacking(dataset, name):
    """What a group lacks, or has in another shape; None = nothing."""
    lacking = [variable for variable in NEEDED.get(name, []) if variable not in dataset]
    lacking += [attribute for attribute in NEEDED_ATTRIBUTES.get(name, []) if attribute not in dataset.attrs]
    if lacking:
        return f"incomplete, the group {name} lacks {', '.join(lacking)}"
    for variable, dimensions in NEEDED.get(name, {}).items():
        if dataset[variable].dims != tuple(dimensions.split()):
            return f"{name}/{variable} is not over {dimensions.replace(' ', ' and ')}"
    return None


def _fault(dataset, name):
    """What is wrong with the values of a variable; None = nothing that is known."""
    values, code = dataset[name].values, name in CODES
    if (values.dtype.kind not in "OSU") if name in TEXT else values.dtype.kind not in ("iu" if code else "iuf"):
        return f"{name} is of another type"
    if code and values.size and not 0 <= values.min() <= values.max() <= (CODES[name] or np.inf):
        return f"{name} has values that mean nothing"
    if name in dataset.dims and values.dtype.kind == "f" and not np.isfinite(values).all():
        return f"{name} is an axis with values that are not finite"
    if name in dataset.dims and name in GRIDS and not (np.diff(values) > 0).all():
        return f"{name} is an axis that does not go up"
    return None


def _attributes(item):
    """The attributes of a file or group as str, int, float or array."""
    return {name: _plain(value) for name, value in item.attrs.items()}


def _plain(value):
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if getattr(value, "size", 0) == 1 else value


def run(main):
    """Calls main() and ends the script: one line and status 1 for a file that cannot be used, or a picture that cannot be written."""
    try:
        main()
    except (BadFile, OSError, MemoryError) as error:
        print(f"error: {_words(error)}", file=sys.stderr)
        sys.exit(1)


def _words(error):
    if isinstance(error, MemoryError):
        return "out of memory"
    named = isinstance(error, OSError) and error.filename
    return f"{error.filename}: {error.strerror}" if named else error
