"""The page of a report, as HTML."""

import base64
import hashlib
import html
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from kapitza import style
from kapitza.measures import measures_of, value_text
from kapitza.report.pictures import pictures
from kapitza.representation import pendulum_text
from kapitza.result import Result
from kapitza.units import with_unit

STYLE = """
body { max-width: 1080px; margin: 24px auto; padding: 0 20px;
       font: 15px/1.5 "DejaVu Sans", Arial, sans-serif; color: #1c2127; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 32px; }
figure { margin: 16px 0; } img { max-width: 100%; } figcaption { color: #6b747e; }
table { border-collapse: collapse; font-size: 13px; } th { text-align: left; font-weight: normal; color: #6b747e; }
th, td { padding: 3px 14px 3px 0; border-bottom: 1px solid #d5dce3; vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.patch { display: inline-block; width: 13px; height: 13px; border: 1px solid #1c2127;
         margin-right: 8px; vertical-align: -2px; }
pre { background: #f4f6f8; padding: 10px; overflow-x: auto; font-size: 13px; } td { overflow-wrap: anywhere; }
"""
# Columns of the table of attractors: heading without its unit, variable or None, how a value is written.
COLUMNS: list[tuple[str, str | None, Callable[[Any], str]]] = [
    ("period", "period", lambda value: str(int(value)) if value > 0 else "-"),
    ("winding", "winding", lambda value: f"{int(value):+d}" if value else "0"),
    ("amplitude", "amplitude", lambda value: f"{value:.3f}"),
    ("|multiplier|", None, lambda value: f"{value:.6f}"),
    ("Lyapunov exponent", "lyapunov", lambda value: f"{value:.5f}"),
    ("± standard error", "lyapunov_error", lambda value: f"{value:.1g}" if value > 0 else "-"),
    ("share of the starts", "fraction", style.share_text),
]
PROVENANCE = ["program", "version", "git_revision", "created", "command", "ranks", "instruction_set", "Conventions"]


def report(result: Result) -> str:
    """The whole page; the same result gives the same bytes."""
    title = result.title
    parts = [f"<p>{_text(pendulum_text(result))}</p>", _pictures(result), _attractors(result), _measures(result),
             _numbers(result), _scene(result), _provenance(result)]
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{_text(title)}</title>'
            f"<style>{STYLE}</style></head>\n<body>\n<h1>{_text(title)}</h1>\n" + "\n".join(filter(None, parts))
            + "\n</body>\n</html>\n")


def _text(value: object) -> str:
    return html.escape(str(value))


def _table(heads: list[str], rows: list[list[str]]) -> str:
    """rows: cells as HTML; those behind the first are numbers."""
    head = "".join(f"<th>{_text(name)}</th>" for name in heads)
    body = "\n".join("<tr>" + "".join(f"<td{' class=number' if place else ''}>{cell}</td>" for place,
                                      cell in enumerate(row)) + "</tr>"
                     for row in rows)
    return f"<table>\n<tr>{head}</tr>\n{body}\n</table>"


def _pictures(result: Result) -> str:
    return "\n".join(
        f'<figure><img alt="{_text(caption)}" src="data:image/png;base64,{base64.b64encode(picture).decode()}">'
                     f"<figcaption>{_text(caption)}</figcaption></figure>" for caption, picture in pictures(result))


def _attractors(result: Result) -> str:
    if "attractors" not in result.groups:
        return ""
    table = result.group("attractors", si=result.pivot_frequency is not None, degrees=True)
    known = [column for column in COLUMNS if column[1] in table or (column[1] is None and "multiplier_re" in table)]
    heads = [with_unit(head, table[variable]) if variable else head for head, variable, _ in known]
    if result.pivot_frequency:
        second = 2 * np.pi / result.pivot_frequency
        known.insert(1, ("", "period", lambda value: f"{value * second:.4g}" if value > 0 else "-"))
        heads.insert(1, "period (s)")
    rows = []
    for index, (name, colour) in enumerate(zip(table["name"].values, style.colours(table), strict=True)):
        cells = [f'<span class="patch" style="background:{colour}"></span>{index} {_text(style.name_text(name))}']
        for _, variable, words in known:
            value = table[variable].values[index] if variable else np.hypot(table["multiplier_re"].values[index, 0],
                                                                            table["multiplier_im"].values[index, 0])
            cells.append(_text(words(value)) if np.isfinite(value) else "-")
        rows.append(cells)
    return "<h2>Attractors</h2>\n" + (_table(["id, name", *heads], rows) if rows else "<p>None.</p>")


def _measures(result: Result) -> str:
    """A row for each measure, a column for each attractor; those of the pendulum are among the numbers."""
    if "measures" not in result.groups:
        return ""
    table = result.group("measures", si=result.pivot_frequency is not None)
    heads = ["", *(f"{index} {style.name_text(name)}" for index, name in enumerate(table["name"].values))]
    rows = [[_text(name.replace("_", " ")),
             *(_text(value_text(table, name, row)) for row in range(table.sizes["attractor"]))]
            for name in measures_of(table)]
    return "<h2>Measures</h2>\n" + _table(heads, rows)


def _numbers(result: Result) -> str:
    """The pendulum, and every attribute of a group; NAME_low and NAME_high are its 95 % interval, NAME_stderr its
    standard error."""
    groups = {"pendulum": result.pendulum} | {name: result.group(name).attrs for name in result.groups
                                              if name != "pendulum"}
    rows = []
    for group, attributes in groups.items():
        for name, value in attributes.items():
            if not name.endswith(("_low", "_high", "_stderr")) and not _is_nan(value):
                rows.append([_text(f"{group}: {name.replace('_', ' ')}"), _value(value) + _interval(name, attributes)])
    return "<h2>Numbers</h2>\n" + _table(["", ""], rows)


def _is_nan(value: Any) -> bool:
    """A number that this scene does not have."""
    return isinstance(value, float | np.floating) and bool(np.isnan(value))


def _value(value: Any) -> str:
    return f"{float(value):.10g}" if isinstance(value, float | np.floating) else _text(value)


def _interval(name: str, attributes: Mapping[Any, Any]) -> str:
    low, high, error = (attributes.get(f"{name}_{end}") for end in ("low", "high", "stderr"))
    if low is not None and high is not None:
        return f" ({_value(low)} to {_value(high)})"
    return f" ± {error:.2g}" if error is not None else ""


def _scene(result: Result) -> str:
    written, resolved = (result.attributes.get(name, "") for name in ("scene", "scene_resolved"))
    changed = re.findall(r"--set[ =](.+?)(?= --?[a-z]|$)", str(result.attributes.get("command", "")))
    options = "".join(f"\n# changed on the command line: --set {option}" for option in changed)
    return (f"<h2>Scene</h2>\n<pre>{_text(str(written).rstrip() + options)}</pre>\n<details><summary>with every "
            "default</summary>"
            f"<pre>{_text(resolved)}</pre></details>")


def _provenance(result: Result) -> str:
    rows = [[_text(name.replace("_", " ")), _text(result.attributes[name])] for name in PROVENANCE
            if name in result.attributes]
    with result.path.open("rb") as file:
        rows.append(["sha256 of the file", hashlib.file_digest(file, "sha256").hexdigest()])
    return "<h2>Provenance</h2>\n" + _table(["", ""], rows).replace(" class=number", "")
