"""The one reader of kapitza's result files (HDF5, netCDF-4 readable)."""

import os
import sys
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import xarray

from kapitza import layout


class BadFile(Exception):
    """A file that cannot be used; the text says which and why, in one line."""


class Result:
    """A complete result file of kapitza: `attributes` of the file, names of its `groups`, attributes of its `pendulum`."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.attributes, self.groups, self.pendulum = self._open()

    def _open(self) -> tuple[dict[str, Any], list[str], dict[str, Any]]:
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

    @cached_property
    def tree(self) -> xarray.DataTree:
        """All groups. Values are read from the file when they are asked for; tree.close() closes it."""
        for name in self.groups:
            if wrong := self._elsewhere(name):
                raise BadFile(f"{self.path}: {wrong}")
        try:
            return xarray.open_datatree(self.path, engine="h5netcdf", phony_dims="sort")
        except Exception as error:
            raise BadFile(f"{self.path}: damaged") from error

    def group(self, name: str) -> xarray.Dataset:
        """The group, read whole; BadFile where the pictures could not be drawn from it."""
        if name not in self.groups:
            held = ", ".join(group for group in self.groups if group != "pendulum") or "none"
            raise BadFile(f"{self.path}: holds no {name} (studies in it: {held})")
        if name in layout.WITH_PENDULUM and not self.pendulum:
            raise BadFile(f"{self.path}: incomplete, lacks the group pendulum")
        try:
            wrong = self._elsewhere(name) or self._too_large(name)
            if not wrong:
                with xarray.open_dataset(self.path, group=name, engine="h5netcdf", phony_dims="sort") as dataset:
                    dataset = dataset.load()
                wrong = layout.wrong_shape(dataset, name) or layout.wrong_values(dataset)
        except Exception as error:  # h5py and h5netcdf raise many kinds for one cause: the bytes are damaged
            raise BadFile(f"{self.path}: damaged in the group {name}") from error
        if wrong:
            raise BadFile(f"{self.path}: {wrong}")
        return dataset

    def _elsewhere(self, name: str) -> str | None:
        """Whether a group keeps data outside this file: as words, or None."""
        with h5py.File(self.path, "r") as file:
            links = [file[name].get(variable, getlink=True) for variable in file[name]]
            if any(isinstance(link, h5py.ExternalLink) for link in links) or any(
                    getattr(item, "external", None) or getattr(item, "is_virtual", False) for item in file[name].values()):
                return f"the group {name} keeps data in another file"
        return None

    def _too_large(self, name: str) -> str | None:
        """Whether a picture of the group would take more memory than there is: as words, or None."""
        with h5py.File(self.path, "r") as file:
            size = sum(item.nbytes for item in file[name].values() if isinstance(item, h5py.Dataset))
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        if 8 * size > memory:  # what reading and drawing it takes
            return f"the group {name} holds {size / 1e9:.3g} GB, too much for a picture with {memory / 1e9:.3g} GB of memory"
        return None


def _attributes(item: h5py.Group) -> dict[str, Any]:
    """The attributes of a file or group as str, int, float or array."""
    return {name: _plain(value) for name, value in item.attrs.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if getattr(value, "size", 0) == 1 else value


def run(main: Callable[[], None]) -> None:
    """Calls main() and ends the script: one line and status 1 for a file that cannot be used, or a picture that cannot be written."""
    try:
        main()
    except (BadFile, OSError, MemoryError) as error:
        print(f"error: {_words(error)}", file=sys.stderr)
        sys.exit(1)


def _words(error: Exception) -> str:
    if isinstance(error, MemoryError):
        return "out of memory"
    named = isinstance(error, OSError) and error.filename
    return f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and named else str(error)
