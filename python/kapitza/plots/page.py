"""The page of a picture: how wide it is, how large its letters are, where its legend stands, what is written on it.
Panels keep their shape on any page."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.legend import Legend
from matplotlib.text import Text

from kapitza import style
from kapitza.plots.line_widths import fix_ticks
from kapitza.result import Result

# Inches of usual letters: on a narrower page the legend stands below, and panels side by side stand one above the other
NARROW = 6.0
LEGENDS = ("right", "below", "none")
BELOW = "below"  # mark of a legend under all panels
SEPARATOR = "   |   "  # between the parts of the line under a picture


class BadOption(ValueError):
    """An option that a picture does not take, or not beside another one."""


@dataclass(frozen=True)
class Page:
    """`width` in inches, None = that of each kind of picture; `font_size` in points; `legend`: one of LEGENDS;
    `colours`: name of an attractor or kind of motion -> colour; `heading`: instead of the scene's title; `axes`: those
    that take the picture, on a page that is somebody else's."""

    width: float | None = None
    font_size: float = style.FONT_SIZE
    legend: str = "right"
    title: bool = True
    heading: str | None = None
    colours: dict[str, str] = field(default_factory=dict)
    axes: Axes | None = None

    @property
    def narrow(self) -> bool:
        return self.inches < NARROW

    @property
    def inches(self) -> float:
        """Width that letters of the usual size have there: a page with letters twice as large has half as many words on
        a line."""
        return float("inf") if self.width is None else self.width / self.scale

    @property
    def scale(self) -> float:
        """Of the letters, and of lines and marks."""
        return self.font_size / style.FONT_SIZE


_current: ContextVar[Page] = ContextVar("page", default=Page())  # noqa: B039  # it is frozen


def current() -> Page:
    """The page that is being drawn."""
    return _current.get()


@contextmanager
def drawing(page: Page) -> Iterator[None]:
    """Figures that are drawn inside have this page's letters and colours."""
    token = _current.set(page)
    try:
        with style.using(page.font_size, page.colours):
            yield
    finally:
        _current.reset(token)


class Picture(Figure):
    """A figure that shows itself in a notebook, and knows its `heading` and the `footer` under its panels."""

    heading: Text | None = None
    footer: Text | None = None

    def _repr_png_(self) -> bytes:
        data = BytesIO()
        self.savefig(data, format="png", dpi=110)
        return data.getvalue()


def new_figure(width: float, height: float) -> Picture:
    """An empty page that no window shows, `width` and `height` inches for letters of the usual size; laid out when it
    is written."""
    if current().axes is not None:
        raise BadOption("ax takes one panel, and this picture has several; choose a view, a measure or a panel of it")
    figure = Picture(figsize=(width * current().scale, height * current().scale), layout="constrained")
    FigureCanvasAgg(figure)  # measures words
    return figure


def new_panels(width: float, height: float, rows: int = 1, columns: int = 1,
               **options: Any) -> tuple[Figure, list[Axes]]:
    """A new figure with its panels, row by row; a single one is the axes of the page, if it has any."""
    axes = current().axes
    if axes is not None and rows * columns == 1:
        return axes.figure.figure, [axes]  # its figure may be a part of one
    figure = new_figure(width, height)
    return figure, list(np.ravel(figure.subplots(rows, columns, **options)))


def title_text(result: Result) -> str:
    """The scene's title, or the file's name: plain text, to be drawn with parse_math=False."""
    return "".join(letter if letter.isprintable() else "?" for letter in result.title)


def entitle(figure: Figure, result: Result, *parts: str) -> None:
    """The title that the page asks for, else the scene's, above the figure; the parts that are not empty below it."""
    if current().axes is not None:
        return
    title = current().heading or title_text(result)
    heading = figure.suptitle(title, x=0.01, ha="left", fontsize="large", fontweight="bold", parse_math=False)
    footer = figure.supxlabel(SEPARATOR.join(filter(None, parts)), x=0.01, ha="left", fontsize="small",
                              color=style.FAINT)
    if isinstance(figure, Picture):
        figure.heading, figure.footer = heading, footer


def lay_out(figure: Figure) -> Figure:
    """Gives the figure the page's width, its legend its place, its words their lines; its first panel keeps its
    shape."""
    page = current()
    if page.axes is not None:
        legend = page.axes.get_legend()
        if legend and page.legend == "none":
            legend.remove()
        return figure
    _arrange(figure)
    shape = _shape(figure) if figure.axes else 1.0
    if not page.title:
        figure.suptitle("")
        figure.supxlabel("")
    if page.width is not None:
        panels = len({round(axes.get_position().y0, 3) for axes in figure.axes})
        figure.set_size_inches(page.width, max(figure.get_figheight() * page.width / figure.get_figwidth(),
                                               page.width * panels))
    if page.legend != "right":
        _move_legends(figure, page.legend == "below")
    heading = getattr(figure, "heading", None)
    if page.narrow and heading:
        heading.set_size("medium")
    _break_lines(figure)
    for _ in range(3 if page.width is not None or page.legend != "right" else 0):
        _break_labels(figure)
        box = figure.axes[0].get_position()
        wide = box.width * figure.get_figwidth()
        figure.set_figheight(min(max(figure.get_figheight() + (shape - _shape(figure)) * wide, 0.8),
                                 4 * figure.get_figwidth()))
    _break_labels(figure)
    if page.width is not None:
        fix_ticks(figure)
    return figure


def _arrange(figure: Figure) -> None:
    """Puts panels and words where the page has room for them, which takes less than half as long as to draw them."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)


def _shape(figure: Figure) -> float:
    """Height over width of the first panel."""
    box = figure.axes[0].get_position()
    return float(box.height * figure.get_figheight() / (box.width * figure.get_figwidth()))


def _move_legends(figure: Figure, below: bool) -> None:
    """Takes the legends beside panels away; `below`: their entries stand under all panels, each once."""
    entries: dict[str, Artist] = {}
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is not None and (not below or _is_beside(axes, legend)):
            entries |= {text: handle for handle, text in _entries(legend) if text not in entries}
            legend.remove()
    if not below or not entries:
        return
    for columns in range(len(entries), 0, -1):
        placed = figure.legend(list(entries.values()), list(entries), loc="outside lower left", ncols=columns,
                               fontsize="small",
                               handlelength=1.1, handleheight=1.1, columnspacing=1.2, borderaxespad=0.2,
                               alignment="left")
        placed.set_gid(BELOW)
        if placed.get_window_extent().width < 0.97 * figure.bbox.width or columns == 1:
            return
        placed.remove()


def _is_beside(axes: Axes, legend: Legend) -> bool:
    """Whether a legend stands to the right of its panel."""
    anchor = legend.get_bbox_to_anchor().transformed(axes.transAxes.inverted())
    return bool(anchor.x0 >= 0.999)


def _entries(legend: Legend) -> Iterator[tuple[Artist, str]]:
    """(handle, text); a share that stands in a column of its own comes behind its name."""
    texts = [text.get_text() for text in legend.get_texts()]
    if legend.get_gid() == style.WITH_SHARES:
        half = len(texts) // 2
        texts = [f"{name} {share.strip(style.FIGURE_SPACE)}" for name,
                 share in zip(texts[:half], texts[half:], strict=True)]
    yield from zip(filter(None, legend.legend_handles), texts, strict=False)


def _break_lines(figure: Figure) -> None:
    """The line under the picture, and the title, on as many lines as the page's width takes; above a legend the first
    is its heading."""
    footer, title = getattr(figure, "footer", None), getattr(figure, "heading", None)
    if footer and footer.get_text():
        footer.set_text(_broken(figure, footer, footer.get_text().split(SEPARATOR), SEPARATOR))
        for legend in figure.legends:
            if legend.get_gid() == BELOW:
                legend.set_title(footer.get_text(), FontProperties(size="small"))
                legend.get_title().set_color(style.FAINT)
                footer.set_text("")
    if title and title.get_text():
        title.set_text(_broken(figure, title, title.get_text().split(" "), " "))


def _broken(figure: Figure, text: Text, parts: list[str], joint: str) -> str:
    """The parts joined on lines that are not wider than the page."""
    lines: list[str] = []
    for part in parts:
        longer = joint.join([*lines[-1:], part])
        text.set_text(longer)
        if lines and text.get_window_extent().width < 0.95 * figure.bbox.width:
            lines[-1] = longer
        else:
            lines.append(part)
    return "\n".join(lines)


def _break_labels(figure: Figure) -> None:
    """Labels of axes that are longer than their panel get their unit on a line of its own."""
    _arrange(figure)
    for axes in figure.axes:
        for axis, room in ((axes.xaxis, axes.bbox.width), (axes.yaxis, axes.bbox.height)):
            box = axis.label.get_window_extent()
            if max(box.width,
                   box.height) > 1.05 * room and "\n" not in axis.get_label_text() and " (" in axis.get_label_text():
                head, tail = axis.get_label_text().rsplit(" (", 1)
                axis.set_label_text(f"{head}\n({tail}")
