"""The process of a view's engine: takes requests by a pipe, and gives frames in shared memory."""

import ctypes
import mmap
import multiprocessing
import os
import signal
import threading
from collections import deque
from contextlib import suppress
from multiprocessing import reduction
from multiprocessing.connection import wait

from kapitza.program import RunError, SceneError

from .requests import BadRequest, packed

ENDING = ("frame", "chart", "cancel")  # requests that end the frame before


def work(connection, engine, scene):
    """The process: makes an engine of a scene and answers requests until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a person ends the server, which ends this
    keep_memory()
    owner = multiprocessing.parent_process()
    threading.Thread(target=lambda: (wait([owner.sentinel]), os._exit(0)), daemon=True).start()
    try:
        worker = Worker(connection, engine(*scene))
    except (SceneError, RunError, OSError, MemoryError) as error:
        connection.send((None, {"answer": "error", "message": str(error) or "memory ran out"}, 0))
        return
    connection.send((None, {"answer": "ready"}, 0))
    with suppress(EOFError, BrokenPipeError):
        worker.run()


def keep_memory():
    """Freed memory is kept for the next frame, as the program keeps it."""
    with suppress(AttributeError):  # not the C library of GNU
        for parameter, most in ((-3, 8 << 20), (-1, 32 << 20)):  # M_MMAP_THRESHOLD, M_TRIM_THRESHOLD
            ctypes.CDLL(None).mallopt(parameter, most)


class Worker:
    """Answers requests in turn; those that are no frame or chart between two parts of one. A newer frame or chart ends
    older ones."""

    def __init__(self, connection, engine):
        self._connection, self._engine = connection, engine
        self._waiting = deque()  # (number, request)
        self._drawn = None       # number of the frame or chart that is being made; None once it is to end

    def run(self):
        while True:
            if not self._waiting:
                self._take(*self._connection.recv())
            self._take_all()
            if self._waiting:
                others = [item for item in self._waiting if not is_drawn(item[1])]
                self._begin(others[0] if others else self._waiting[0])

    def _take_all(self):
        while self._connection.poll():
            self._take(*self._connection.recv())

    def _take(self, number, request):
        """What has come: it waits, but for what ends others."""
        if request.get("request") in ENDING:
            for item in [item for item in self._waiting if is_drawn(item[1])]:
                self._waiting.remove(item)
                self._end(item[0])
            self._drawn = None
        if request.get("request") == "cancel":
            self._end(number)
        else:
            self._waiting.append((number, request))

    def _begin(self, item):
        self._waiting.remove(item)
        if is_drawn(item[1]):
            self._drawn = item[0]
        self._answer(*item)

    def _between(self):
        """Between two parts of a frame: whether it goes on."""
        self._take_all()
        while self._drawn is not None and (others := [item for item in self._waiting if not is_drawn(item[1])]):
            self._begin(others[0])
            self._take_all()
        return self._drawn is not None

    def _answer(self, number, request):
        try:
            if not self._engine.answers(request, lambda header, planes: self._send(number, header, planes),
                                        self._between):
                self._end(number)
        except (BadRequest, SceneError, RunError, MemoryError, ValueError) as error:
            self._send(number, plain_error(error))

    def _end(self, number):
        self._send(number, {"answer": "ended", "final": True})

    def _send(self, number, header, planes=()):
        size = sum(plane.nbytes for plane in planes)
        self._connection.send((number, header, size))
        if size == 0:
            return
        file = os.memfd_create("planes")
        try:
            os.ftruncate(file, size)
            with mmap.mmap(file, size) as memory:
                for part in packed(planes):
                    memory.write(part)
            reduction.send_handle(self._connection, file, None)
        finally:
            os.close(file)


def plain_error(error):
    """The answer that an exception becomes: status 2 if the request is wrong, 1 if it failed."""
    status = 1 if isinstance(error, RunError | MemoryError) else 2
    return {"answer": "error", "final": True, "status": status, "message": str(error) or "memory ran out"}


def is_drawn(request):
    return request.get("request") in ("frame", "chart")
