"""How a command of the package ends: one line and a status, whatever a file holds."""

import os
import signal
import sys
import tempfile
from collections.abc import Callable, Sequence

from kapitza.program import RunError, SceneError
from kapitza.result import BadFile


def run_script(main: Callable[[], None]) -> None:
    """Calls main() and ends the script: one line and status 1 for a file that cannot be used, or a picture that cannot
    be written; 2 for a scene that is refused."""
    try:
        main()
        sys.stdout.flush()
    except SceneError as error:
        print(f"kapitza: error: {error}", file=sys.stderr)
        sys.exit(2)
    except (BadFile, RunError, OSError, MemoryError) as error:
        print(f"kapitza: error: {_words(error)}", file=sys.stderr)
        if isinstance(error, BrokenPipeError | OSError):
            _forget_stdout()
        sys.exit(1)


def words_of(flags: Sequence[str] = ()) -> list[str]:
    """The command line that the program passes on, each option in one word with its value, which may begin with -."""
    words: list[str] = []
    left = iter(sys.argv[1:])
    for word in left:
        if word == "--":
            return [*words, word, *left]
        words.append(word if word in flags else f"{word}={next(left)}")
    return words


def run_apart(main: Callable[[], None]) -> None:
    """run_script(main) in a child process: a file that makes the HDF5 library itself crash costs one line as well."""
    with tempfile.TemporaryFile() as errors:
        if (child := os.fork()) == 0:
            os.dup2(errors.fileno(), 2)
            _end_child(main)
        _, status = os.waitpid(child, 0)
        errors.seek(0)
        said = errors.read().decode(errors="replace")
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE,
                                                          signal.SIGILL):
        print("kapitza: error: the file is damaged: reading it crashed the HDF5 library", file=sys.stderr)
        sys.exit(1)
    sys.stderr.write(said)
    sys.exit(os.waitstatus_to_exitcode(status) if not os.WIFSIGNALED(status) else 128 + os.WTERMSIG(status))


def _end_child(main: Callable[[], None]) -> None:
    status = 1
    try:
        run_script(main)
        status = 0
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    sys.stderr.flush()
    os._exit(status)


def _forget_stdout() -> None:
    """What cannot be written is not tried again when Python ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _words(error: Exception) -> str:
    if isinstance(error, MemoryError):
        return "out of memory"
    named = isinstance(error, OSError) and error.filename
    return f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and named else str(error)
