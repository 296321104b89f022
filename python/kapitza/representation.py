"""What a result says of itself in a session: a few lines, the same as HTML with a small picture, and its figures."""

import base64
import html
import io
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import xarray

from kapitza.plots.atlas_classes import lacking_text, missing_text
from kapitza.style import TORQUES
from kapitza.units import si_parameters

if TYPE_CHECKING:
    from kapitza.result import Result

MOST = 12  # attractors that are listed
COLUMNS: dict[str, Callable[[Any], str]] = {"name": str, "period": str, "winding": str, "fraction": "{:.2%}".format}


def pendulum_text(result: "Result") -> str:
    """The pendulum: of a scene in SI units as people build it, else in the papers' symbols."""
    pendulum = result.pendulum
    papers = [f"{symbol} = {pendulum[key]:.6g}" for symbol, key in
              (("Q", "quality_factor"), ("Omega", "drive_frequency"), ("epsilon", "drive_amplitude"))
              if key in pendulum]
    own = [f"{name} = {pendulum[name]:.6g}" for name in ("k", "beta", "m", *TORQUES) if name in pendulum]
    return ", ".join([*si_parameters(pendulum).values(), *own] if "pivot_frequency" in pendulum else own + papers)


def _studies(result: "Result") -> list[str]:
    """A line for each group: its name and size."""
    lines = []
    for name in result.groups:
        if name not in ("pendulum", "attractors"):
            try:
                with xarray.open_dataset(result.path, group=name, engine="h5netcdf", phony_dims="sort") as dataset:
                    sizes, missing = dataset.sizes, missing_text(dataset)
                    if "lacking_high" in dataset.attrs:
                        missing += f"; {lacking_text(dataset.attrs['lacking_high'])}"
            except Exception:  # the error of a damaged file depends on the damage
                lines.append(f"{name}: damaged")
            else:
                lines.append(f"{name}: " + " x ".join(f"{size} {axis}" for axis, size in sizes.items()) + missing)
    return lines


def _rows(result: "Result") -> list[list[str]]:
    """The first attractors, the largest basins before the others: id and COLUMNS as texts."""
    if "attractors" not in result.groups:
        return []
    table = result.attractors
    if "fraction" in table:
        table = table.sort_values("fraction", ascending=False, kind="stable")
    known = [name for name in COLUMNS if name in table]
    return [["id", *known], *([str(index), *(COLUMNS[name](row[name]) for name in known)] for index,
                              row in table.head(MOST).iterrows())]


def _more(result: "Result") -> str:
    count = len(result.attractors) - MOST if "attractors" in result.groups else 0
    return f"and {count} more attractors: see .attractors" if count > 0 else ""


def as_text(result: "Result") -> str:
    """The title, the pendulum, the groups and the attractors, a line each."""
    rows = _rows(result)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    table = ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
             for row in rows]
    lines = [result.title, pendulum_text(result), *_studies(result), *table, _more(result)]
    return "\n".join(filter(None, lines))


def main() -> None:
    """The command `kapitza info`."""
    from kapitza.exit_status import run_apart
    from kapitza.result import Result
    run_apart(lambda: print(as_text(Result(sys.argv[1]))))


def as_html(result: "Result") -> str:
    """The same beside a small picture of the main group."""
    rows = _rows(result)
    head = "".join(f"<th>{html.escape(name)}</th>" for name in (rows[0] if rows else []))
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows[1:])
    lines = pendulum_text(result), *_studies(result), _more(result), str(result.path)
    words = "".join(f"<div>{html.escape(line)}</div>" for line in lines if line)
    return (f"<div style='display:flex;gap:1.5em;flex-wrap:wrap'><div><b>{html.escape(result.title)}</b>{words}"
            f"<table><tr>{head}</tr>{body}</table></div>{_picture(result)}</div>")


def _picture(result: "Result") -> str:
    from kapitza.result import BadFile
    try:
        figure = result.plot(no_title=True, legend="none", width="90mm")
    except BadFile:
        return ""
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=100)
    return f"<img alt='' style='height:17em' src='data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}'>"


def main_kind(result: "Result") -> str:
    """The kind of picture that shows the main study of a result."""
    from kapitza.plots.kinds import KINDS
    from kapitza.result import BadFile
    if kind := next((name for name in KINDS if name in result.groups), None):
        return kind
    raise BadFile(f"{result.path}: contains no study that can be drawn")
