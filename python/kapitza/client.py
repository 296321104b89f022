"""A process of `kapitza serve` (docs/reference/serve.md), shared by threads: what an Engine and the views of the explorer ask."""

import itertools
import json
import os
import queue
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from kapitza.program import ERROR, SceneError, environment

START = 60.0       # seconds until the process must be ready
CLOSE = 1.0        # seconds in which it ends by itself
MOST_BYTES = 65_536  # longest request
CATALOGUES = 8     # versions that are remembered
Answer = tuple[dict[str, Any], bytes]  # header, payload


class Ended(Exception):
    """The process has ended. The text is the last line of the program; `status`: its exit status; `errors`: all that it wrote."""

    def __init__(self, text: str, status: int, errors: str) -> None:
        super().__init__(text)
        self.status, self.errors = status, errors


class Pending:
    """A request that has been sent."""

    def __init__(self, client: "Client", number: int | None) -> None:
        self.number, self.answered = number, threading.Event()
        self._client = client
        self._answers: queue.SimpleQueue[Answer | None] = queue.SimpleQueue()

    def put(self, answer: Answer | None) -> None:
        """An answer that has come; None: the process has ended."""
        self._answers.put(answer)
        if answer is None or answer[0]["final"]:
            self.answered.set()

    def next(self, timeout: float | None = None) -> Answer:
        """The next answer. Ended, if none can come; TimeoutError after `timeout` seconds, with the program's last line."""
        try:
            answer = self._answers.get(timeout=timeout)
        except queue.Empty:
            words = self._client.last_words()
            raise TimeoutError(f"no answer from the program after {timeout:g} s" + (f": {words}" if words else "")) from None
        if answer is None:
            raise self._client.end()
        return answer


class Client:
    """One process; it ends when its standard input does, and so with this process, however this ends.

    :param command: the command line
    :param descriptors: files that it inherits
    :param change: applied to the header of every catalogue
    """

    def __init__(self, command: Sequence[str], descriptors: Sequence[int] = (),
                 change: Callable[[dict[str, Any]], None] = lambda header: None) -> None:
        self._owner = os.getpid()
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                         env=environment(), pass_fds=descriptors, start_new_session=True)
        self.catalogues: dict[int, dict[str, Any]] = {}  # the last ones, by version
        self._change, self._errors, self._finished = change, [""], False
        self._sending, self._lock, self._numbers = threading.Lock(), threading.Lock(), itertools.count(1)
        first = Pending(self, None)
        self._waiting: dict[int | None, Pending] = {None: first}
        self._error_reader = threading.Thread(target=self._read_errors, daemon=True)
        self._error_reader.start()
        threading.Thread(target=self._read, daemon=True).start()
        try:
            self.ready, _ = first.next(START)
        except BaseException:
            self.close()
            raise

    def send(self, request: dict[str, Any]) -> Pending:
        """Sends a request, to which it gives a number. Ended, if the process has."""
        if os.getpid() != self._owner:
            raise RuntimeError("the engine belongs to the process that began it; a forked process begins one of its own")
        pending = Pending(self, next(self._numbers))
        line = json.dumps(request | {"sequence": pending.number}).encode() + b"\n"
        if len(line) > MOST_BYTES + 1:
            raise SceneError(f"request: has more than {MOST_BYTES} bytes")
        with self._lock:
            if self._finished:
                raise self.end()
            self._waiting[pending.number] = pending
        try:
            with self._sending:
                assert self._process.stdin
                self._process.stdin.write(line)
                self._process.stdin.flush()
        except (OSError, ValueError) as error:
            with self._lock:
                self._waiting.pop(pending.number, None)
            raise self.end() from error
        return pending

    def _read(self) -> None:
        """Gives each answer to its request. At the end everybody that waits is woken."""
        assert self._process.stdout
        try:
            while line := self._process.stdout.readline():
                header = json.loads(line)
                self._hand_over(header, self._process.stdout.read(header["bytes"]))
        except (ValueError, KeyError, OSError):
            self._process.kill()  # it was ended amid an answer, or is another program
        self._process.wait()
        self._error_reader.join(1)  # its last words may still be on their way
        with self._lock:
            self._finished = True
            for pending in self._waiting.values():
                pending.put(None)

    def _hand_over(self, header: dict[str, Any], payload: bytes) -> None:
        """To the request of that number; an answer without one, to a line that was not understood, goes to all."""
        if header["answer"] == "catalogue":
            self._keep(header)
        with self._lock:
            number = header["sequence"]
            for pending in list(self._waiting.values()) if number is None else [self._waiting.get(number)]:
                if pending is not None:
                    pending.put((header, payload))
            if header["final"]:
                self._waiting.pop(number, None)

    def _keep(self, header: dict[str, Any]) -> None:
        self._change(header)
        self.catalogues[header["version"]] = header
        while len(self.catalogues) > CATALOGUES:
            del self.catalogues[next(iter(self.catalogues))]

    def _read_errors(self) -> None:
        assert self._process.stderr
        with self._process.stderr as stream:
            for line in stream:
                self._errors = [*self._errors, line.decode(errors="replace")][-50:]

    def last_words(self) -> str:
        """The last line of the program that is an error, without its prefix; "" if there is none."""
        lines = [line for line in "".join(self._errors).splitlines() if line.startswith(ERROR)]
        return lines[-1].removeprefix(ERROR) if lines else ""

    def end(self) -> Ended:
        """Why no answer comes, once the process has ended."""
        self._process.wait()
        self._error_reader.join(1)
        return Ended(self.last_words() or "the program has ended", self._process.returncode, "".join(self._errors))

    @property
    def ended(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None

    def close(self) -> None:
        """Ends the process: at once where it does not end by itself. A forked process leaves that of its parent alone."""
        if os.getpid() != self._owner:
            return
        end = time.monotonic() + CLOSE
        if self._sending.acquire(timeout=CLOSE):
            with suppress(OSError, ValueError):
                assert self._process.stdin
                self._process.stdin.write(b'{"request": "quit"}\n')
                self._process.stdin.close()
            self._sending.release()
        try:
            self._process.wait(max(0.0, end - time.monotonic()))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
