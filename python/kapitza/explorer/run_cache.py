"""Runs that the page asks for: computed in the background, and kept for the next time."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from kapitza.program import ERROR, environment
from kapitza.result import BadFile, Result

from .process import Refused

PATIENCE = 0.2   # seconds between two words on the progress; a page that has gone is noticed by them
MOST_KEPT = 100  # results; the oldest go first
LEFT = 3600.0    # seconds after which nobody works in a folder that has not changed
CALM = 5         # added to its nice value: the page's pictures go first
DAMAGE = (BadFile, LookupError, OSError, RuntimeError, TypeError, ValueError)  # errors of reading a damaged file
# Python that becomes the command behind it, which Linux kills with this process, however this ends (1:
# PR_SET_PDEATHSIG, 9: SIGKILL). Not a
# preexec_fn, which is not safe beside threads.
BOUND = """import ctypes, os, sys
ctypes.CDLL(None).prctl(1, 9)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[2:])
"""


_PLACE = re.compile(r"^-:\d+:\d+: ")  # in a text that nobody wrote


class RunCache:
    """Those of one explorer. `program`: the executable; `numerics`: of its scene, or None; `folder`: None = in the
    user's cache."""

    def __init__(self, program, numerics=None, folder=None):
        self._program, self._folder = Path(program), folder and Path(folder)
        self._common = {"numerics": numerics} if numerics else {}
        self._running = set()

    def has(self, scene):
        """Whether the result of a scene is there."""
        return self._place(scene).exists()

    def name(self, scene):
        """By which requests of the page name the result of a scene."""
        return self._place(scene).stem

    def path(self, name):
        """Of the result of that name; None where there is none any more."""
        path = self._results() / f"{name}.h5"
        return str(path) if re.fullmatch("[0-9a-f]{32}", str(name)) and path.exists() else None

    def answers(self, scene, make, calm=CALM, **more):
        """(header, payload) of each answer: `progress` while the program computes, `calm` nicer than the page's
        pictures, then what `make` makes of the result, with the keys `more`. A kept result that is damaged is computed
        again. Refused, with the program's words, where it cannot compute it."""
        path, made = self._place(scene), None
        if path.exists():
            try:
                made = make(Result(path))
            except DAMAGE:
                path.unlink(missing_ok=True)
        if made is None:
            for _ in self._run(scene, path, calm):
                yield {"answer": "progress", "final": False, "bytes": 0}, b""
            made = make(Result(path))
        header, payload = made
        yield header | {"bytes": len(payload)} | more, payload

    def close(self):
        """Ends what is being computed."""
        for process in list(self._running):
            process.kill()

    def _text(self, scene):
        return json.dumps(self._common | scene, sort_keys=True)

    def _place(self, scene):
        """Where the result of a scene is kept: that of another program, or of another scene, has another place."""
        program = self._program.stat()
        name = hashlib.sha256(f"{program.st_size} {program.st_mtime_ns} {self._text(scene)}".encode()).hexdigest()
        return self._results() / f"{name[:32]}.h5"

    def _results(self):
        """The folder of the results; one that ends with this process where nothing can be written to the cache."""
        if self._folder is None:
            self._folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "kapitza"
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                tempfile.TemporaryFile(dir=self._folder).close()
            except OSError:
                self._temporary = tempfile.TemporaryDirectory(prefix="kapitza-view-")
                self._folder = Path(self._temporary.name)
        return self._folder

    def _run(self, scene, path, calm):
        """Computes a result; yields now and then. The program has its bytes on the disk before it ends."""
        _tidy(path.parent)
        with tempfile.TemporaryDirectory(dir=path.parent) as folder:
            made, words, errors = (Path(folder) / name for name in ("result.h5", "scene", "errors"))
            words.write_text(self._text(scene))
            command = [str(self._program), "run", "-", "-o", str(made), "--progress", "never"]
            with words.open() as given, errors.open("w") as said:
                process = subprocess.Popen([sys.executable, "-ISc", BOUND, str(os.getpid()), *command], stdin=given,
                                           stdout=subprocess.DEVNULL, stderr=said, env=environment(),
                                           start_new_session=True)
            self._running.add(process)
            try:
                os.setpriority(os.PRIO_PROCESS, process.pid, calm)
                while process.poll() is None:
                    os.utime(folder)  # it is in use
                    yield
                    with suppress(subprocess.TimeoutExpired):
                        process.wait(PATIENCE)
            finally:
                process.kill()
                process.wait()
                self._running.discard(process)
            if process.returncode != 0:
                said = (errors.read_text().strip().splitlines() or ["it could not be computed"])[-1]
                raise Refused(_PLACE.sub("", said.removeprefix(ERROR)))
            os.replace(made, path)


def _tidy(results):
    """Removes the oldest results, and folders that explorers have left which were killed; another explorer may be at it
    too."""
    with suppress(FileNotFoundError):
        for old in sorted(results.glob("*.h5"), key=lambda file: file.stat().st_mtime)[:1 - MOST_KEPT]:
            old.unlink()
        for folder in results.glob("tmp*"):
            if time.time() - folder.stat().st_mtime > LEFT:
                shutil.rmtree(folder, ignore_errors=True)
