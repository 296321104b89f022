"""The one reader of kapitza's result files (HDF5, netCDF-4 readable).

>>> result = Result("blackburn-fig12.h5")
>>> basin = result.group("basin")           # an xarray.Dataset, in memory
>>> result.pendulum["k"], result.attributes["title"]
"""

import sys
from pathlib import Path

import h5py
import xarray

# Variables without which a group is of no use to any script; the study that writes a group adds its row here.
NEEDED = {
    "attractors": ["period", "winding", "centre", "name", "mirror", "strobe_theta", "strobe_velocity"],
    "orbit": ["time", "theta", "velocity", "pivot", "strobe_time", "strobe_theta", "strobe_velocity", "maximum_time",
              "maximum_angle", "line_frequency", "line_amplitude", "line_phase"],
    "stability": ["k", "m", "log_multiplier", "angle", "stable"],
    "potential": ["theta", "drive_amplitude", "energy", "energy_blackburn", "energy_simple", "rim_exact"],
    "tradeoff": ["label", "method", "precision", "scheme", "interpolation", "wrong", "wrong_low", "wrong_high", "seconds",
                 "seconds_per_million_cells", "pareto"],
    "basin": ["theta", "velocity", "attractor", "settling_time", "evidence"],
    "sweep": ["value"],
}


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
                groups = [name for name, item in file.items() if isinstance(item, h5py.Group)]
                attributes, pendulum = _attributes(file), _attributes(file["pendulum"]) if "pendulum" in groups else {}
        except OSError as error:
            reason = "truncated" if "truncated" in str(error) else "not an HDF5 file, or damaged"
            raise BadFile(f"{self.path}: {reason}") from error
        except (KeyError, RuntimeError, ValueError) as error:
            raise BadFile(f"{self.path}: damaged") from error
        if attributes.get("program") != "kapitza":
            raise BadFile(f"{self.path}: not a result of kapitza")
        if "pendulum" in groups and not {"k", "beta", "m"} <= pendulum.keys():
            raise BadFile(f"{self.path}: incomplete, the group pendulum lacks k, beta or m")
        return attributes, groups, pendulum

    def group(self, name):
        """The group as an xarray.Dataset, read whole."""
        if name not in self.groups:
            held = ", ".join(group for group in self.groups if group != "pendulum") or "none"
            raise BadFile(f"{self.path}: holds no {name} (studies in it: {held})")
        try:
            with xarray.open_dataset(self.path, group=name, engine="h5netcdf") as dataset:
                dataset = dataset.load()
        except Exception as error:  # h5py and h5netcdf raise many kinds for one cause: the bytes are damaged
            raise BadFile(f"{self.path}: damaged in the group {name}") from error
        lacking = [variable for variable in NEEDED.get(name, []) if variable not in dataset]
        if lacking:
            raise BadFile(f"{self.path}: incomplete, the group {name} lacks {', '.join(lacking)}")
        return dataset


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
    except (BadFile, OSError) as error:
        print(f"error: {_words(error)}", file=sys.stderr)
        sys.exit(1)


def _words(error):
    named = isinstance(error, OSError) and error.filename
    return f"{error.filename}: {error.strerror}" if named else error
