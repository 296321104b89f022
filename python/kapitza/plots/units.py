"""Axes in the units of a laboratory: degrees, and the seconds, rad/s and Hz of a scene in SI units."""

import argparse

from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, Locator, LogFormatterSciNotation, LogLocator, MaxNLocator, NullFormatter

from kapitza.result import BadFile, Result


class _ScaledLocator(Locator):
    """Ticks that are round where the axis is multiplied by `factor`."""

    def __init__(self, round_ticks: Locator, factor: float) -> None:
        self.round_ticks, self.factor = round_ticks, factor

    def tick_values(self, vmin: float, vmax: float) -> list[float]:
        return [tick / self.factor for tick in self.round_ticks.tick_values(vmin * self.factor, vmax * self.factor)]

    def __call__(self) -> list[float]:
        return self.tick_values(*self.axis.get_view_interval())  # type: ignore[union-attr]


def show_in(axis: Axis, factor: float, label: str) -> None:
    """Labels an axis by its values times `factor`, linear or logarithmic."""
    logarithmic = axis.get_scale() == "log"
    axis.set_major_locator(_ScaledLocator(LogLocator() if logarithmic else MaxNLocator(7, steps=[1, 2, 2.5, 5, 10]), factor))
    if logarithmic:
        words = LogFormatterSciNotation()
        axis.set_major_formatter(FuncFormatter(lambda value, _: words(value * factor)))
        axis.set_minor_locator(_ScaledLocator(LogLocator(subs="auto"), factor))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{round(value * factor, 12):.6g}".replace("-", "−")))
    axis.set_label_text(label)


def add_si(parser: argparse.ArgumentParser, what: str) -> None:
    """The option --si; `what` says which axes it changes."""
    parser.add_argument("--si", action="store_true", help=f"{what}, of a scene in SI units")


def in_si(result: Result) -> bool:
    """Whether the scene of a result is in SI units."""
    value = result.pendulum.get("pivot_frequency")
    return isinstance(value, float) and value > 0


def pivot_frequency(result: Result) -> float:
    """The drive's angular frequency in rad/s; BadFile where the scene was not in SI units."""
    if not in_si(result):
        raise BadFile(f"{result.path}: has no pivot_frequency, because its scene is not in SI units; leave out --si")
    return float(result.pendulum["pivot_frequency"])
