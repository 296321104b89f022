"""libkapitza in this process: its header is the declaration (cffi, ABI mode). Results become arrays and datasets,
failures exceptions."""

import os
import re
import threading
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from kapitza.program import RunError, SceneError
from kapitza.scene import passed_on

if TYPE_CHECKING:
    import xarray

OK, FAILED, REFUSED, NO_MEMORY, STOPPED = 0, 1, 2, 3, 75
NO_TURNS = -(2**31)
_KEY = re.compile(r"(?P<place>scene:\d+:\d+|basin|change): (?P<key>[a-z_]\w*(?:\.\w+)*): ")
_raised = threading.local()  # the exception of a signal handler that stopped the call of this thread


def _place(name: str) -> Path:
    """A file of the library: beside the sources around this package (build/, include/), or in its installation."""
    root = Path(__file__).resolve().parents[2]
    built = root / ("include" if name.endswith(".h") else "build") / name
    return built if built.is_file() and (root / "CMakeLists.txt").is_file() else Path(__file__).with_name(name)


class Library:
    """The loaded library: `lib` has its functions, `ffi` their types."""

    def __init__(self, path: Path, header: Path) -> None:
        from cffi import FFI
        text = re.sub(r"#ifdef __cplusplus.*?#endif", "", header.read_text(encoding="utf-8"), flags=re.DOTALL)
        self.ffi = FFI()
        self.ffi.cdef(re.sub(r"^#.*$", "", text, flags=re.MULTILINE))
        self.lib = self.ffi.dlopen(str(path))
        self._pause = self.ffi.callback("kapitza_pause", lambda context: 0, error=1, onerror=_keep)

    def call(self, name: str, *arguments: Any) -> None:
        """Calls a function that returns a status. Signal handlers of Python run meanwhile; what they raise ends the
        call."""
        if threading.current_thread() is threading.main_thread():
            self.lib.kapitza_set_pause(self._pause, self.ffi.NULL)
        status = getattr(self.lib, name)(*arguments)
        if status != OK:
            self._fail(status)

    def _fail(self, status: int) -> NoReturn:
        text = self.ffi.string(self.lib.kapitza_message()).decode(errors="replace")
        if status == STOPPED:
            stopped, _raised.exception = getattr(_raised, "exception", None), None
            raise stopped or KeyboardInterrupt(text)
        if status == NO_MEMORY:
            raise MemoryError(text)
        if status != REFUSED:
            raise RunError(text)
        found = _KEY.match(text)
        raise SceneError(text.removeprefix(found["place"] + ": ") if found else text, found and found["key"])

    def view(self, array: np.ndarray | None, kind: str = "double *") -> Any:
        """The array as an argument; None = NULL."""
        return self.ffi.NULL if array is None else self.ffi.cast(kind, array.ctypes.data)

    def text(self, text: str | bytes | None) -> Any:
        """A text as an argument, which must be kept until the call has ended; None = NULL."""
        given = passed_on(text, file_name=True).encode(errors="surrogateescape") if isinstance(text, str) else text
        return self.ffi.NULL if given is None else self.ffi.from_buffer(given + b"\0")

    def texts(self, texts: Sequence[str]) -> tuple[Any, list[Any]]:
        """An array of texts as an argument, and what must be kept as long."""
        kept = [self.text(text) for text in texts]
        return self.ffi.new("char *[]", kept), kept

    def scene(self, text: str | bytes, name: str, sets: Sequence[str]) -> tuple[Any, list[Any]]:
        """A kapitza_scene, and what must be kept as long."""
        array, kept = self.texts(sets)
        kept += [array, self.text(text), self.text(name)]
        return self.ffi.new("kapitza_scene *", {"text": kept[-2], "name": kept[-1], "sets": array,
                                                "n_sets": len(sets)}), kept

    def array(self, pointer: Any, count: int, dtype: Any) -> np.ndarray:
        """A copy of `count` numbers."""
        return np.frombuffer(self.ffi.buffer(pointer, count * np.dtype(dtype).itemsize),
                             dtype).copy() if count else np.empty(0, dtype)

    def cycles(self, given: Any, dimension: str) -> "xarray.Dataset":
        """A list of attractors or cycles, which is freed, as the group of a file has it."""
        try:
            return self._cycles(given[0], dimension)
        finally:
            self.lib.kapitza_free(given)

    def _cycles(self, listed: Any, dimension: str) -> "xarray.Dataset":
        import xarray  # not for the engine of the explorer, which starts sooner without it
        rows = [listed.cycle[index] for index in range(listed.count)]
        points = np.full((2, len(rows), max([row.period for row in rows], default=1) or 1), np.nan)
        for place, row in enumerate(rows):
            points[:, place, :row.period] = [self.array(row.theta, row.period, float),
                                             self.array(row.velocity, row.period, float)]
        values: dict[str, Any] = {"name": (dimension, np.array([self.ffi.string(row.name).decode() for row in rows],
                                                               dtype=object))}
        for name, kind in (("period", np.int32), ("winding", np.int32), ("centre", np.int8), ("symmetric", np.int8),
                           ("mirror", np.int32),
                           ("amplitude", float), ("mean_velocity", float), ("lyapunov", float),
                           ("lyapunov_error", float)):
            values[name] = (dimension, np.array([getattr(row, name) for row in rows], dtype=kind))
        for part in ("re", "im"):
            pairs = [list(getattr(row, f"multiplier_{part}")) if row.period else [np.nan, np.nan] for row in rows]
            values[f"multiplier_{part}"] = ((dimension, "pair"), np.array(pairs, dtype=float).reshape(-1, 2))
        values["strobe_theta"] = ((dimension, "phase"), points[0], {"units": "rad"})
        values["strobe_velocity"] = ((dimension, "phase"), points[1], {"units": "1"})
        return xarray.Dataset(values)


def _keep(kind: type, exception: BaseException, traceback: object) -> int:
    _raised.exception = exception
    return 1


@cache
def load() -> Library:
    """The library of this installation, that beside the program which the variable KAPITZA names, or that of
    KAPITZA_LIBRARY."""
    chosen, beside = os.environ.get("KAPITZA_LIBRARY"), Path(os.environ.get("KAPITZA", "")).with_name("libkapitza.so") \
        if os.environ.get("KAPITZA") else None
    path = Path(chosen) if chosen else beside if beside and beside.is_file() else _place("libkapitza.so")
    header = _place("kapitza.h")
    if not (path.is_file() and header.is_file()):
        raise FileNotFoundError(
            "libkapitza.so is not installed: `pip install .` in its sources builds it, and so does scripts/setup; "
                                "or name it by the variable KAPITZA_LIBRARY")
    return Library(path, header)
