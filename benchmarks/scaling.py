"""Predicts how long the command for a basin takes on many ranks, from the --log of a run on one rank.

    scaling.py predict [--grid N] [--plot FILE] [--ranks R...] NAME=LOG... seconds and efficiency; --grid: on N x N
    cells
    scaling.py page FILE the figure of docs/validation/benchmarks.md, from its table
    scaling.py load [--grid N] LOG seconds of its tiles, for build/benchmarks/uneven
    scaling.py share [--slower X] [--ranks R...] FILE what build/benchmarks/uneven FILE X will measure

docs/validation/benchmarks.md says what is assumed, how the costs of messages were measured (messages.c), and how good
it is.
"""

import argparse
import json
import math
import sys
from dataclasses import dataclass, fields
from pathlib import Path

from matplotlib.figure import Figure
from scaling_model import Costs, Stage, collective, delivered, resampled

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

from kapitza import style  # noqa: E402

COLLECTIVES = 10  # calls of a stage (src/parallel/stage.c)
# Of a tile: whole rows, a multiple of five (src/study/basin/tiles.c); the mirrored half costs none
TILE_CELLS, BOX = 16384, 5
GRID = ("cells 1", "file")  # stages whose tiles become more with the grid
WRITING = "file: writing"
WRITING_CELL = 2.2e-10  # s of rank 0 for the packed bytes of a cell: messages of 10^6 cells against those of 80,000
PAGE = Path(__file__).resolve().parents[1] / "docs" / "validation" / "benchmarks.md"
COLOURS = ("#2f6db3", "#c2452f", "#12806a")


@dataclass
class Run:
    """A logged run on one rank: processor seconds of its stages' tiles, and of what no stage holds."""
    cells: int
    stages: list  # of (name, seconds of its tiles)
    between: float
    take: float = 0.0  # for a message of the stage `file`, on rank 0

    @staticmethod
    def read(path):
        """The last run of a log."""
        events = [json.loads(line) for line in Path(path).read_text().splitlines()]
        events = events[max(i for i, event in enumerate(events) if event["event"] == "begin"):]
        if events[0]["ranks"] != 1 or events[-1].get("status") != 0:
            sys.exit(f"{path}: its last run is no complete one on one rank")
        stages, tiles = [], {}
        for event in events:
            if event["event"] == "tiles":
                tiles.setdefault(event["stage"], []).extend(event["processor"])
            elif event["event"] == "stage":
                stages.append((event["stage"], tiles.pop(event["stage"], [])))
        take = tiles.get(WRITING, [0])
        return Run(events[0]["cells"], stages, events[-1]["outside"], sum(take) / len(take))

    def refined(self, grid):
        """The same window on grid x grid cells: other tiles, with as many seconds for a cell of the same place."""
        n = math.ceil(grid / max(BOX, TILE_CELLS // grid // BOX * BOX) / 2)
        more = grid * grid / self.cells
        stages = [(name, [more * s for s in resampled(tiles, n)] if name in GRID else tiles) for name,
                  tiles in self.stages]
        longer = grid * grid / n - self.cells / len(dict(self.stages)["file"])  # messages, in cells
        return Run(grid * grid, stages, self.between, self.take + WRITING_CELL * longer)

    def seconds(self):
        """Of one rank."""
        return self.between + sum(sum(tiles) + self.take * len(tiles) * (name == "file") for name, tiles in self.stages)

    def predict(self, ranks, costs):
        """Seconds of what lies between the stages and of each stage, on so many ranks with cores of their own."""
        seconds, workers = {"between": self.between}, None
        for name, tiles in self.stages:
            if name == "file":
                spent = delivered(workers, tiles, self.take)
            else:
                stage = Stage(tiles, ranks, costs)
                spent, workers = stage.end, stage.workers if name == "cells 1" else workers
            seconds[name] = seconds.get(name, 0) + spent + (COLLECTIVES * collective(ranks, costs) if ranks > 1 else 0)
        return seconds


def predictions(run, numbers, costs):
    """Ranks, seconds, efficiency against one rank, and the two longest parts."""
    for ranks in numbers:
        parts = run.predict(ranks, costs)
        total = sum(parts.values())
        longest = sorted(parts, key=parts.get, reverse=True)[:2]
        yield ranks, total, run.seconds() / (ranks * total), ", ".join(f"{name} {parts[name]:.2g} s"
                                                                       for name in longest)


def draw(curves, path):
    """Seconds and efficiency of each scene against the number of ranks, 178 mm wide."""
    with style.using(8):
        figure = Figure(figsize=(178 / 25.4, 3.1), layout="constrained")
        left, right = figure.subplots(1, 2)
        for (name, rows), colour, marker in zip(curves.items(), COLOURS, "osv", strict=False):
            ranks, seconds, efficiency, *_ = zip(*rows, strict=True)
            left.loglog(ranks, seconds, color=colour, marker=marker, markersize=4, label=name)
            left.loglog(ranks, [seconds[0] * ranks[0] / n for n in ranks], color=colour, linestyle=":", linewidth=0.8)
            right.semilogx(ranks, efficiency, color=colour, marker=marker, markersize=4)
        left.plot([], [], color=style.INK, linestyle=":", linewidth=0.8, label="shared evenly")
        left.set(xlabel="ranks", ylabel="whole command (s)")
        right.set(xlabel="ranks", ylabel="efficiency", ylim=(0, 1.05))
        left.legend(fontsize="small", loc="lower left")
        style.save(figure, Path(path), 300)
        print(path)


def page(options):
    """Rows "| name | seconds (efficiency) | ..." of the table with the ranks in its head."""
    lines = [[cell.strip() for cell in line.strip("| \n").split("|")] for line in PAGE.read_text().splitlines()
             if line.startswith("|")]
    head = next(i for i, cells in enumerate(lines) if cells[0] == "seconds (efficiency)")
    ranks = [int(cell.split()[0].replace(",", "")) for cell in lines[head][1:-1]]
    curves = {}
    for name, *cells, _ in lines[head + 2:head + 5]:
        seconds = [float(cell.split()[0].replace(",", "")) for cell in cells]
        curves[name] = [(n, s, seconds[0] / (n * s)) for n, s in zip(ranks, seconds, strict=True)]
    draw(curves, options.file)


def named_logs(words):
    return {name: Run.read(path) for name, path in (word.split("=", 1) for word in words)}


def predict(options):
    runs, curves = named_logs(options.logs), {}
    costs = Costs(options.message, options.look, options.answer)
    for name, run in runs.items():
        run = run.refined(options.grid) if options.grid else run
        print(f"{name}: {run.cells:.3g} cells, {run.seconds():.4g} s on one rank")
        curves[name] = list(predictions(run, options.ranks, costs))
        for ranks, seconds, efficiency, longest in curves[name]:
            print(f"{ranks:8d} ranks {seconds:10.2f} s  efficiency {efficiency:6.1%}  {longest}", flush=True)
    if options.plot:
        draw(curves, options.plot)


def load(options):
    run = Run.read(options.log)
    for seconds in dict((run.refined(options.grid) if options.grid else run).stages)["cells 1"]:
        print(f"{seconds:.6f}")


def share(options):
    seconds = [float(line) for line in Path(options.load).read_text().split()]
    for ranks in options.ranks:
        stage = Stage(seconds, ranks, Costs(options.message, options.look, options.answer), options.slower)
        print(f"{ranks:8d} ranks {stage.end:10.2f} s  idle {stage.idle():.1%}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    makers = {"predict": predict, "page": page, "load": load, "share": share}
    parsers = {name: commands.add_parser(name) for name in makers}
    for name in ("predict", "share"):
        for field in fields(Costs):
            parsers[name].add_argument(f"--{field.name}", type=float, default=field.default)
    parsers["predict"].add_argument("logs", nargs="+", metavar="NAME=LOG")
    parsers["predict"].add_argument("--plot", metavar="FILE")
    parsers["page"].add_argument("file", metavar="FILE")
    for name in ("predict", "load"):
        parsers[name].add_argument("--grid", type=int, help="cells along each axis, instead of those of the log")
    parsers["load"].add_argument("log", metavar="LOG")
    parsers["share"].add_argument("--slower", type=float, default=1, help="factor of the last rank's seconds")
    parsers["share"].add_argument("load", metavar="FILE")
    for name in ("predict", "share"):
        parsers[name].add_argument("--ranks", type=int, nargs="+", default=[1, 2, 8])
    options = parser.parse_args()
    makers[options.command](options)


if __name__ == "__main__":
    main()
