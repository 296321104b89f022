"""`kapitza plot vtkhdf FILE [-o FILE.vtkhdf]`: a small file beside a result through which ParaView and VTK read its
basins.

It is VTK's own HDF layout (ImageData, version 2.0), whose cells are external links to the variables of FILE: both move
together.
"""

import os
import tempfile
from pathlib import Path

import h5py
import numpy as np

from kapitza.options import Parser, wrong_ending
from kapitza.result import BadFile, Result

VARIABLES = ("attractor", "settling_time", "evidence")  # variables of the group basin, over velocity and theta


def write(result: Result, output: Path) -> None:
    """Writes the sidecar of a result that holds a basin; it appears under its name when it is complete."""
    if "basin" not in result.groups:
        raise BadFile(f"{result.path}: holds no basin")
    if output.exists() and output.samefile(result.path):
        raise BadFile(f"{output}: is the result itself; choose another name for the sidecar")
    try:
        extent, origin, spacing = _window(result)
    # H5py's words for bytes that are damaged
    except (AttributeError, KeyError, OSError, RuntimeError, TypeError, ValueError) as error:
        raise BadFile(f"{result.path}: damaged in the group basin") from error
    link = os.path.relpath(result.path.resolve(), output.resolve().parent)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".kapitza-") as folder:
        made = Path(folder) / output.name
        with h5py.File(made, "w") as file:
            group = file.create_group("VTKHDF")
            group.attrs["Version"] = np.array([2, 0], dtype="i4")
            group.attrs.create("Type", b"ImageData", dtype=h5py.string_dtype("ascii", len("ImageData")))
            group.attrs["WholeExtent"] = np.array(extent, dtype="i4")
            group.attrs["Origin"], group.attrs["Spacing"] = np.array(origin), np.array(spacing)
            group.attrs["Direction"] = np.eye(3).ravel()
            cells = group.create_group("CellData")
            for name in VARIABLES:
                cells[name] = h5py.ExternalLink(link, f"/basin/{name}")
        with made.open("rb") as file:
            os.fsync(file.fileno())  # a name never outlives its bytes
        os.replace(made, output)


def _window(result: Result) -> tuple[list[int], list[float], list[float]]:
    """Extent, lower corner and size of the cells: theta along x, velocity along y; BadFile where the group is not
    whole."""
    with h5py.File(result.path, "r") as file:
        group = file["basin"]
        lacking = [name for name in ("theta", "velocity", *VARIABLES) if name not in group]
        if lacking:
            raise BadFile(f"{result.path}: incomplete, the group basin lacks {', '.join(lacking)}")
        axes = [_axis(group, name) for name in ("theta", "velocity")]
        shape = (len(axes[1]), len(axes[0]))
        if 0 in shape or any(group[name].shape != shape for name in VARIABLES):
            raise BadFile(f"{result.path}: the group basin has variables of another shape than its axes")
    sizes = [float((axis[-1] - axis[0]) / (len(axis) - 1)) if len(axis) > 1 else 1.0 for axis in axes]
    corner = [float(axis[0]) - size / 2 for axis, size in zip(axes, sizes, strict=True)]
    return [0, shape[1], 0, shape[0], 0, 0], [*corner, 0.0], [*sizes, 1.0]


def _axis(group: h5py.Group, name: str) -> np.ndarray:
    """The cell centres; where doubles do not tell them apart, as shares of the window's width from its centre."""
    values = group[name][:]
    offset = f"{name}_offset" in group and not (np.diff(values) > 0).all()
    return np.asarray(group[f"{name}_offset"][:] if offset else values)


def main(words: list[str]) -> None:
    """Writes the sidecar of a result file, and prints its name."""
    parser = Parser(prog="kapitza plot vtkhdf",
                                     description="a small file through which ParaView reads the basins of a result")
    parser.add_argument("file", type=Path, help="result file that holds a basin")
    parser.add_argument("-o", "--output", type=Path, help="the sidecar (default: beside FILE, with .vtkhdf)")
    given = parser.parse_args(words)
    output = given.output or given.file.with_suffix(".vtkhdf")
    if output.suffix.lower() != ".vtkhdf":
        parser.error(wrong_ending(output, [".vtkhdf"]))
    write(Result(given.file), output)
    print(output)
