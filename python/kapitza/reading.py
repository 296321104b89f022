"""What is read of a result file, and checked: its attributes, its pendulum, its groups."""

import os
import shutil
import tempfile
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import h5py
import numpy as np
import xarray

from kapitza import layout, units

SMALL = 100_000
"""Bytes: groups up to this size are kept."""


class BadFile(Exception):
    """A file cannot be used. The text is one line: which file, and why."""


def opened(path: Path) -> tuple[dict[str, Any], list[str], dict[str, Any]]:
    """The attributes of a result file, the names of its groups, and the numbers of its pendulum.

    :raises BadFile: if the file is not a complete result, or is damaged
    """
    if not path.is_file():
        raise BadFile(f"{path}: {'not a file' if path.exists() else 'no such file'}")
    try:
        with h5py.File(path, "r") as file:
            groups = [name for name in file if file.get(name, getclass=True, getlink=True) is h5py.HardLink
                      and isinstance(file[name], h5py.Group)]
            attributes, pendulum = _attributes(file), _attributes(file["pendulum"]) if "pendulum" in groups else {}
    except OSError as error:
        reason = "truncated" if "truncated" in str(error) else "not an HDF5 file, or damaged"
        if path.suffix in (".yaml", ".yml"):
            reason = f"is a scene, not a result; kapitza run {path} makes its result {path.stem}.h5"
        raise BadFile(f"{path}: {reason}") from error
    except (KeyError, RuntimeError, ValueError) as error:
        raise BadFile(f"{path}: damaged") from error
    if attributes.get("program") != "kapitza":
        raise BadFile(f"{path}: not a result of kapitza")
    if "pendulum" in groups and not all(isinstance(pendulum.get(name), int | float) for name in ("k", "beta", "m")):
        raise BadFile(f"{path}: incomplete, the group pendulum lacks k, beta or m")
    return attributes, groups, pendulum


def group_of(path: Path, name: str, groups: list[str], pendulum: dict[str, Any]) -> xarray.Dataset:
    """A group of a file, read completely.

    :param groups: the names of the groups of the file
    :param pendulum: the numbers of its pendulum
    :raises BadFile: if there is no such group, or if it is damaged or too large for the memory
    """
    if name not in groups:
        held = ", ".join(group for group in groups if group != "pendulum") or "none"
        raise BadFile(f"{path}: holds no {name} (studies in it: {held})")
    if name in layout.WITH_PENDULUM and not pendulum:
        raise BadFile(f"{path}: incomplete, lacks the group pendulum")
    try:
        wrong = elsewhere(path, name) or _too_large(path, name)
        if not wrong:
            with xarray.open_dataset(path, group=name, engine="h5netcdf", phony_dims="sort") as dataset:
                dataset = dataset.load()
            wrong = layout.wrong_shape(dataset, name) or layout.wrong_values(dataset, name)
    except Exception as error:  # h5py and h5netcdf raise many kinds for one cause: the bytes are damaged
        raise BadFile(f"{path}: damaged in the group {name}") from error
    if wrong:
        raise BadFile(f"{path}: {wrong}")
    return dataset


def arrays_of(path: Path, name: str) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """The variables and the attributes of a group as they are in the file, texts as str: what xarray adds takes many
    times longer.

    :raises BadFile: if there is no such group, or if it is damaged
    """
    try:
        with h5py.File(path, "r") as file:
            group = file[name]
            return {key: item.asstr()[:] if item.dtype == object else item[:] for key,
                    item in group.items()}, _attributes(group)
    except (OSError, KeyError, RuntimeError, ValueError) as error:
        raise BadFile(f"{path}: damaged in the group {name}") from error


def elsewhere(path: Path, name: str) -> str | None:
    """Whether a group keeps data outside this file: as words, or None."""
    with h5py.File(path, "r") as file:
        links = [file[name].get(variable, getlink=True) for variable in file[name]]
        if any(isinstance(link, h5py.ExternalLink) for link in links) or any(
                getattr(item, "external", None) or getattr(item, "is_virtual", False) for item in file[name].values()):
            return f"the group {name} keeps data in another file"
    return None


def _too_large(path: Path, name: str) -> str | None:
    """Whether a picture of the group would take more memory than there is: as words, or None."""
    with h5py.File(path, "r") as file:
        size = sum(item.nbytes for item in file[name].values() if isinstance(item, h5py.Dataset))
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if 8 * size > memory:  # memory for reading and drawing it
        return (f"the group {name} holds {size / 1e9:.3g} GB, too much for a picture with {memory / 1e9:.3g} GB of "
                "memory")
    return None


def _attributes(item: h5py.Group) -> dict[str, Any]:
    """The attributes of a file or group as str, int, float or array."""
    return {name: _plain(value) for name, value in item.attrs.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if getattr(value, "size", 0) == 1 else value


class File:
    """A complete file: its attributes, and its groups as numbers. `summary`: what the run has printed.

    :raises BadFile: if the file is not a complete result, or is damaged
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.summary = ""
        self.attributes, self.groups, self.pendulum = opened(self.path)
        self._small: dict[str, xarray.Dataset] = {}

    @cached_property
    def tree(self) -> xarray.DataTree:
        """All groups as an xarray.DataTree, which reads values from the file when they are needed. `tree.close()`
        closes the file."""
        for name in self.groups:
            if wrong := elsewhere(self.path, name):
                raise BadFile(f"{self.path}: {wrong}")
        try:
            return xarray.open_datatree(self.path, engine="h5netcdf", phony_dims="sort")
        except Exception as error:
            raise BadFile(f"{self.path}: damaged") from error

    @property
    def title(self) -> str:
        """The title of the scene; the name of the file if the scene has no title."""
        title = self.attributes.get("title")
        return title if isinstance(title, str) and title else self.path.stem

    @property
    def scene(self) -> str:
        """The scene with every default, as YAML text. `kapitza.run` of it gives the same numbers."""
        return str(self.attributes.get("scene_resolved", ""))

    @property
    def pivot_frequency(self) -> float | None:
        """The angular frequency of the drive in rad/s; None if the scene is not in SI units."""
        value = self.pendulum.get("pivot_frequency")
        return value if isinstance(value, float) and value > 0 else None

    def group(self, name: str, *, si: bool = False, degrees: bool = False, written: bool = False) -> xarray.Dataset:
        """Reads a group of the file completely.

        :param si: velocities in rad/s, times in s and frequencies in Hz, of a scene in SI units; the attribute `units`
            of each says so
        :param degrees: angles in degrees
        :param written: values of a key that was swept in the unit that the scene writes, such as mm; the file has them
            in m
        :raises BadFile: if the file has no such group, if the group is damaged or too large for the memory, or if `si`
            is asked of a scene that is not in SI units
        """
        if si and self.pivot_frequency is None:
            raise BadFile(f"{self.path}: has no pivot_frequency, because its scene is not in SI units; leave out si")
        dataset = self._read(name)
        dataset = units.in_units(dataset, self.pivot_frequency if si else None, degrees) if si or degrees else dataset
        return units.in_written_units(dataset, name, layout.axes_of(name)) if written else dataset

    def add(self, group: str, dataset: xarray.Dataset) -> Self:
        """A result with one more group, or another one of that name: what kapitza.manifolds, wada and tangency return.
        The file is replaced when it is complete.

        >>> result.add("manifolds", kapitza.manifolds(kapitza.Pendulum(result.scene), result.group("saddles"),
        kind="stable"))
        """
        if not group.isidentifier() or group == "pendulum" or group in self.groups and group not in layout.ADDED:
            raise ValueError(
                f"{group!r} cannot be added; it must be another name than those of the program's own groups")
        with tempfile.NamedTemporaryFile(dir=self.path.parent, prefix=self.path.name, delete=False) as new:
            try:
                shutil.copy(self.path, new.name)  # with its mode
                with h5py.File(new.name, "r+") as file:
                    file.pop(group, None)
                dataset.to_netcdf(new.name, mode="a", group=group, engine="h5netcdf")
                os.replace(new.name, self.path)
            except BaseException:
                os.unlink(new.name)
                raise
        return type(self)(self.path)

    def _read(self, name: str) -> xarray.Dataset:
        """A group as it is in the file, which the caller may change. Of small ones a copy is kept, as xarray takes long
        to open a group."""
        if name in self._small:
            return self._small[name].copy(deep=True)
        dataset = group_of(self.path, name, self.groups, self.pendulum)
        if dataset.nbytes <= SMALL:
            self._small[name] = dataset.copy(deep=True)
        return dataset
