"""The program as the explorer keeps it: one `kapitza serve` for each view of a page, its answers passed on as they come."""

import re
import threading
import time
from contextlib import suppress

from kapitza.client import Client, Ended
from kapitza.program import ERROR, SceneError

from .colours import Colours

MOST_VIEWS = 6       # programs at once; the one that has waited longest ends for a new one
PATIENCE = 2.0       # seconds until a program must have ended a frame that a newer one, or a person, ends
ENDING = ("frame", "chart", "cancel")  # requests that end the frame before
_PLACE = re.compile(r"^(-|/proc/self/fd/\d+)?:\d+:\d+: ")


class Unresponsive(Exception):
    """The program does not end what a newer request, or a person, wants ended."""


class Refused(Exception):
    """The program's own words on why it does not answer."""


def plain(message):
    """A message without its prefix, and without the place in a text that nobody wrote."""
    return _PLACE.sub("", message.strip().removeprefix(ERROR))


class View:
    """One program at work."""

    def __init__(self, command, descriptors=()):
        self._last_frame, self._closed, self._colours = None, False, Colours()
        self.used = time.monotonic()
        try:
            self._client = Client(command, descriptors, self._colour)
        except OSError as error:  # a program that is not ready in time too
            raise Refused(f"the program cannot be started: {error.strerror or error}") from error
        except Ended as end:
            raise Refused(plain(str(end))) from end
        self.ready = self._client.ready

    def _colour(self, catalogue):
        catalogue["attractors"] = self._colours.added(catalogue["attractors"])

    def answers(self, request):
        """(header, payload) of each answer to the request. A frame's catalogue comes before it, whichever request brought it. Requests
        that end frames have a view of their own in the program, so that a cancelled frame ends no orbit."""
        kind, before, sent, final = request.get("request"), self._last_frame, set(), False
        named = request | {"view": "frame" if kind in ENDING else ""}
        self.used = time.monotonic()
        try:
            pending = self._client.send(named)
        except SceneError as error:  # its line is too long
            raise Refused(str(error)) from error
        if kind in ENDING:
            self._last_frame = pending
        try:
            if kind in ENDING and before and not before.answered.wait(PATIENCE):
                raise Unresponsive
            while not final:
                header, payload = self._next(pending, kind)
                self.used, final, version = time.monotonic(), header["final"], header.get("catalogue")
                if header["answer"] == "frame" and version not in sent and version in self._client.catalogues:
                    sent.add(version)
                    yield self._client.catalogues[version] | {"sequence": pending.number, "final": False}, b""
                if header["answer"] != "catalogue" or kind == "catalogue":
                    yield header, payload
        finally:
            if not final and pending is self._last_frame:  # nobody reads on
                with suppress(Ended):
                    self._client.send({"request": "cancel", "view": "frame"})

    def _next(self, pending, kind):
        """The next answer; at the program's end an error in its words, or `ended` where another program has taken its place."""
        try:
            header, payload = pending.next()
        except Ended as end:
            answer = "ended" if self._closed and kind in ENDING else "error"
            header, payload = {"answer": answer, "final": True, "bytes": 0, "status": 1, "message": str(end)}, b""
        if header["answer"] == "error":
            header = header | {"message": plain(header["message"])}
        return header, payload

    @property
    def ended(self):
        return self._client.ended

    def close(self):
        """Ends the program, at once where it does not end by itself; what it still computes has ended."""
        self._closed = True
        self._client.close()


class Views:
    """The programs by the names that pages give their views."""

    def __init__(self, command, descriptors=()):
        self._command, self._descriptors = command, descriptors
        self._lock = threading.Lock()
        self._views = {}

    def answers(self, name, request):
        """Those of the view of that name. A program that does not end a frame is replaced: a new one is ready sooner."""
        try:
            yield from self.view(name).answers(request)
        except (Unresponsive, Ended):
            self.close(name)
            try:
                yield from self.view(name).answers(request)
            except (Unresponsive, Ended) as error:
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
