"""Engines in processes of their own, one for each view of a page. The end of one is told and mended by another."""

import itertools
import mmap
import multiprocessing
import os
import queue
import signal
import threading
import time
from contextlib import suppress
from multiprocessing import reduction
from multiprocessing.connection import Connection

from .requests import Engine
from .worker import ENDING, work

CONTEXT = multiprocessing.get_context("spawn")
MOST_VIEWS = 6       # processes at once; the one that has waited longest ends for a new one
START = 60.0         # seconds until a process must be ready
PATIENCE = 2.0       # seconds until it must have ended a frame that a newer one, or a person, ends


class Refused(Exception):
    """Why there is no answer, in the words of who refuses."""


class Ended(Exception):
    """The process has ended; the text says how."""


class Unresponsive(Exception):
    """The process does not end what a newer request, or a person, wants ended."""


class Pending:
    """A request that has been sent: its answers as they come, None at the end of the process."""

    def __init__(self, number):
        self.number, self.answered, self._answers = number, threading.Event(), queue.SimpleQueue()

    def put(self, answer):
        self._answers.put(answer)
        if answer is None or answer[0]["final"]:
            self.answered.set()

    def next(self):
        return self._answers.get()


class View:
    """One process at work. `add`: what a catalogue is given for the page."""

    def __init__(self, engine, scene, add):
        self._connection, theirs = CONTEXT.Pipe()
        self._process = CONTEXT.Process(target=work, args=(theirs, engine, scene), daemon=True)
        self._process.start()
        theirs.close()
        self._add, self._lock, self._numbers, self._waiting = add, threading.Lock(), itertools.count(1), {}
        self._last_frame, self._closed, self._finished = None, False, False
        self.used = time.monotonic()
        try:
            said = (self._connection.recv()[1]
                    if self._connection.poll(START) else {"message": "the engine is not ready in time"})
        except EOFError:
            said = {"message": self._why()}
        if said.get("answer") != "ready":
            self.close()
            raise Refused(said["message"])
        threading.Thread(target=self._receive, daemon=True).start()

    def _receive(self):
        """Gives each answer to its request. At the end everybody that waits is woken."""
        with suppress(EOFError, OSError):
            while True:
                number, header, size = self._connection.recv()
                payload = _taken(self._connection, size) if size else b""
                if header["answer"] == "catalogue":
                    self._add(header)
                with self._lock:
                    pending = self._waiting.pop(number, None) if header["final"] else self._waiting.get(number)
                if pending:
                    pending.put((header | {"sequence": number, "bytes": size}, payload))
        with self._lock:
            self._finished = True
            waiting, self._waiting = list(self._waiting.values()), {}
        for pending in waiting:
            pending.put(None)

    def _send(self, request):
        with self._lock:
            if self._finished:
                raise Ended(self._why())
            pending = Pending(next(self._numbers))
            self._waiting[pending.number] = pending
            try:
                self._connection.send((pending.number, request))
            except OSError:
                raise Ended(self._why()) from None
            return pending

    def _why(self):
        self._process.join(1)
        code = self._process.exitcode
        return (f"the engine has ended ({signal.Signals(-code).name})"
                if code is not None and code < 0 else "the engine has ended")

    def answers(self, request):
        """(header, payload) of each answer to the request; Ended where the process ends before the last one, unless
        another was wanted."""
        kind, before, final = request.get("request"), self._last_frame, False
        self.used = time.monotonic()
        pending = self._send(request)
        if kind in ENDING:
            self._last_frame = pending
        try:
            if kind in ENDING and before and not before.answered.wait(PATIENCE):
                raise Unresponsive
            while not final:
                answer = pending.next()
                if answer is None and not self._closed:
                    raise Ended(self._why())
                header, payload = answer or ({"answer": "ended", "final": True, "bytes": 0}, b"")
                self.used, final = time.monotonic(), header["final"]
                yield header, payload
        finally:
            if not final and pending is self._last_frame:  # nobody reads on
                with suppress(Ended):
                    self._send({"request": "cancel"})

    @property
    def ended(self):
        return self._finished or not self._process.is_alive()

    def close(self):
        """Ends the process at once; what it computes ends."""
        self._closed = True
        self._process.kill()
        self._process.join()


def _taken(connection: Connection, size):
    """The planes of an answer, out of the shared memory."""
    file = reduction.recv_handle(connection)
    try:
        with mmap.mmap(file, size, prot=mmap.PROT_READ) as memory:
            return memory[:]
    finally:
        os.close(file)


class Views:
    """The engines by the names that pages give their views. `colours`: makes what adds colours to the catalogues of a
    view."""

    def __init__(self, scene, colours, engine=Engine):
        self._arguments, self._colours = (engine, scene), colours
        self._lock = threading.Lock()
        self._views = {}

    def answers(self, name, request):
        """Those of the view of that name. An engine that ends, or does not end a frame, is replaced, which the next
        answer tells by `restarted`; a request at which two end is answered by an error."""
        view = self.view(name)
        try:
            yield from view.answers(request)
            return
        except Ended as end:
            told = {"restarted": str(end)}
        except Unresponsive:
            told = {}
        self._drop(name, view)
        try:
            for header, payload in self.view(name).answers(request):
                yield header | told, payload
                told = {}
        except (Unresponsive, Ended) as end:
            yield {"answer": "error", "final": True, "bytes": 0, "status": 1, "message": str(end)
                   or "the engine has ended"}, b""

    def view(self, name):
        """The view of that name; begun where there is none."""
        with self._lock:
            found = self._views.get(name)
            if found is None or found.ended:
                while len(self._views) >= MOST_VIEWS:
                    self._views.pop(min(self._views, key=lambda other: self._views[other].used)).close()
                found = self._views[name] = View(*self._arguments, self._colours())
            return found

    def _drop(self, name, view):
        """Ends a view, unless another has its name by now."""
        with self._lock:
            if self._views.get(name) is view:
                del self._views[name]
        view.close()

    def rename(self, old, new):
        """The engine that was begun before any page came serves the first view."""
        with self._lock:
            if old in self._views and new not in self._views:
                self._views[new] = self._views.pop(old)

    def close(self, name=None):
        """Ends the view of that name, or all."""
        with self._lock:
            names = list(self._views) if name is None else [name] if name in self._views else []
            for ending in names:
                self._views.pop(ending).close()
