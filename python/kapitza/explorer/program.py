"""The program as the explorer keeps it: one `kapitza serve` for each view of a page, its answers passed on as they come."""

import itertools
import json
import queue
import re
import subprocess
import threading
import time
from contextlib import suppress

from .colours import Colours

MOST_VIEWS = 6       # programs at once; the one that has waited longest ends for a new one
START = 60.0         # seconds until a program must be ready
PATIENCE = 2.0       # seconds until a program must have ended a frame that a newer one, or a person, ends
ENDING = ("frame", "chart", "cancel")  # requests that end the frame before
CATALOGUES = 8       # versions that are remembered
_PLACE = re.compile(r"^(-|/proc/self/fd/\d+)?:\d+:\d+: ")


class Deaf(Exception):
    """The program does not end what a newer request, or a person, wants ended."""


class Gone(Exception):
    """The program has ended before the request reached it."""


class Refused(Exception):
    """The program's own words on why it does not answer."""


def plain(message):
    """A message without its prefix, and without the place in a text that nobody wrote."""
    return _PLACE.sub("", message.strip().removeprefix("kapitza: error: "))


class View:
    """One program at work. It ends when its standard input does, and so with this process, however this ends."""

    def __init__(self, command, descriptors=()):
        try:
            self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                             pass_fds=descriptors, start_new_session=True)
        except OSError as error:
            raise Refused(f"the program cannot be started: {error.strerror}") from error
        self.used = time.monotonic()
        self._lock = threading.Lock()
        self._numbers, self._waiting, self._last_frame = itertools.count(1), {}, None
        self._unanswered = set()  # numbers of requests whose last answer has not come
        self._frames = set()      # numbers of requests that a newer one may end
        self._catalogues, self._colours = {}, Colours()
        self._errors, self._closed = [], False
        first = self._waiting[None] = queue.SimpleQueue()
        self._error_reader = threading.Thread(target=self._read_errors, daemon=True)
        self._error_reader.start()
        threading.Thread(target=self._read, daemon=True).start()
        try:
            self.ready, _ = first.get(timeout=START)
        except queue.Empty:
            self.close()
            raise Refused(f"the program is not ready after {START:g} s") from None
        if self.ready["answer"] != "ready":
            self.close()
            raise Refused(self.ready["message"])

    def answers(self, request):
        """(header, payload) of each answer to the request. A frame's catalogue is said before it, whoever heard it before."""
        number, said, mine = next(self._numbers), set(), queue.SimpleQueue()
        kind, before = request.get("request"), self._last_frame
        with self._lock:
            self._waiting[number] = mine
            self._unanswered.add(number)
            if kind in ENDING:
                self._last_frame = number
                self._frames.add(number)
        self.used, final = time.monotonic(), False
        try:
            self._send(request | {"sequence": number})
            if kind in ENDING:
                self._check_heard(before)
            while not final:
                header, payload = mine.get()
                self.used, final, version = time.monotonic(), header["final"], header.get("catalogue")
                if header["answer"] == "frame" and version not in said and version in self._catalogues:
                    said.add(version)
                    yield self._catalogues[version] | {"sequence": number, "final": False}, b""
                if header["answer"] != "catalogue" or kind == "catalogue":
                    yield header, payload
        finally:
            with self._lock:
                self._waiting.pop(number, None)
                self._frames.discard(number)
            if not final and number == self._last_frame:  # nobody reads on
                with suppress(Gone):
                    self._send({"request": "cancel", "sequence": next(self._numbers)})

    def _check_heard(self, number):
        """Waits until the program has answered the request before for the last time."""
        end = time.monotonic() + PATIENCE
        while number in self._unanswered:
            if time.monotonic() > end:
                raise Deaf
            time.sleep(0.005)

    def _send(self, request):
        try:
            with self._lock:
                self._process.stdin.write(json.dumps(request).encode() + b"\n")
                self._process.stdin.flush()
        except (OSError, ValueError) as error:
            raise Gone from error

    def _read(self):
        """Gives each answer to the request that it belongs to; at the end everybody who waits hears why."""
        try:
            while line := self._process.stdout.readline():
                header = json.loads(line)
                payload = self._process.stdout.read(header["bytes"])
                if header["answer"] == "error":
                    header["message"] = plain(header["message"])
                if header["answer"] == "catalogue":
                    self._keep_catalogue(header)
                with self._lock:
                    waiting = self._waiting.get(header["sequence"])
                    if header["final"]:
                        self._unanswered.discard(header["sequence"])
                if waiting is not None:
                    waiting.put((header, payload))
        except (ValueError, KeyError, OSError):
            pass  # it was ended amid an answer
        self._process.wait()
        words = self._end_words()
        last = {"answer": "error", "final": True, "bytes": 0, "status": 1, "message": words}
        with self._lock:
            for number, waiting in self._waiting.items():
                is_superseded = self._closed and number in self._frames
                waiting.put((last | {"answer": "ended"} if is_superseded else last, b""))

    def _keep_catalogue(self, header):
        header["attractors"] = self._colours.added(header["attractors"])
        self._catalogues[header["version"]] = header
        while len(self._catalogues) > CATALOGUES:
            del self._catalogues[next(iter(self._catalogues))]

    def _read_errors(self):
        with self._process.stderr as stream:
            for line in stream:
                self._errors = [*self._errors, line.decode(errors="replace").strip()][-5:]

    def _end_words(self):
        self._error_reader.join(1)  # its last words may still be on their way
        said = [line for line in self._errors if line.startswith("kapitza: error: ")]
        return plain(said[-1]) if said else "the program has ended"

    @property
    def ended(self):
        return self._process.poll() is not None

    def close(self):
        """Ends the program, at once where it does not go by itself; what it still computes has ended."""
        self._closed = True
        with suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(0.5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class Views:
    """The programs by the names that pages give their views."""

    def __init__(self, command, descriptors=()):
        self._command, self._descriptors = command, descriptors
        self._lock = threading.Lock()
        self._views = {}

    def answers(self, name, request):
        """Those of the view of that name. A program that does not hear is ended: a new one is ready sooner."""
        try:
            yield from self.view(name).answers(request)
        except (Deaf, Gone):
            self.close(name)
            try:
                yield from self.view(name).answers(request)
            except (Deaf, Gone) as error:
                raise Refused("the program has ended") from error

    def view(self, name):
        """The view of that name; begun where there is none."""
        with self._lock:
            found = self._views.get(name)
            if found is None or found.ended:
                while len(self._views) >= MOST_VIEWS:
                    self._views.pop(min(self._views, key=lambda other: self._views[other].used)).close()
                found = self._views[name] = View(self._command, self._descriptors)
            return found

    def rename(self, old, new):
        """The program that was begun before any page came serves the first view."""
        with self._lock:
            if old in self._views and new not in self._views:
                self._views[new] = self._views.pop(old)

    def close(self, name=None):
        """Ends the view of that name, or all."""
        with self._lock:
            names = list(self._views) if name is None else [name] if name in self._views else []
            for ending in names:
                self._views.pop(ending).close()
