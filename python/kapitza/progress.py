"""The progress of a run, read from the log that the program writes, as a bar in a terminal or a notebook."""

import json
import warnings
from pathlib import Path
from typing import Any

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # a notebook without ipywidgets gets a bar of text
    from tqdm.auto import tqdm


class Progress:
    """Follows the log at `path`. Nothing is shown where `shown` is false, nor before a run has taken a second."""

    def __init__(self, path: Path, shown: bool) -> None:
        self.path, self.shown = path, shown
        self.place, self.rest, self.stage = 0, "", ""
        self.bar: Any = None

    def look(self) -> None:
        """Reads what the log has new."""
        if not self.shown or not self.path.exists():
            return
        with self.path.open(encoding="utf-8") as log:
            log.seek(self.place)
            self.rest += log.read()
            self.place = log.tell()
        *lines, self.rest = self.rest.split("\n")
        for line in lines:
            event = json.loads(line)
            if event["event"] == "progress":
                self._show(str(event["stage"]), int(event["done"]), int(event["total"]))

    def _show(self, stage: str, done: int, total: int) -> None:
        if self.bar is None:
            self.bar = tqdm(unit="tile", leave=False, disable=None)  # a bar in a terminal or a notebook, not in a file
        if stage != self.stage or total != self.bar.total:
            self.stage = stage
            self.bar.reset(total)
            self.bar.set_description(stage)
        self.bar.update(done - self.bar.n)

    def close(self) -> None:
        """Takes the bar away."""
        if self.bar is not None:
            self.bar.close()
