"""Connections of the explorer's server: so many at once, so long until they have shown a token. Those that have keep
their place."""

import resource
import threading
import time
from contextlib import suppress
from http.server import ThreadingHTTPServer
from socket import SHUT_RDWR, SO_REUSEADDR, SOL_SOCKET

MOST = 128           # at once
BACKLOG = 1024       # connections that the system keeps until they are accepted
STRANGER = 10.0      # seconds, from the first to the last, of a connection that shows no token
IDLE = 600.0         # seconds between two requests of a page


class Gate:
    """The open connections and when each must end."""

    def __init__(self):
        self._lock = threading.Lock()
        self._ends = {}         # socket: time, or None while a page's request is answered
        self._pages = set()     # sockets that have shown a token
        self._most = max(8, min(MOST, resource.getrlimit(resource.RLIMIT_NOFILE)[0] // 4))
        self._stop = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    def enter(self, connection):
        """A new connection; where there are too many, the oldest without a token ends, or this one."""
        with self._lock:
            if len(self._ends) >= self._most and not self._end_oldest():
                return False
            self._ends[connection] = time.monotonic() + STRANGER
            return True

    def make_way(self):
        """Ends the oldest connection without a token: the process has no descriptor left."""
        with self._lock:
            self._end_oldest()

    def _end_oldest(self):
        """Connections are kept in the order in which they came."""
        oldest = next((connection for connection in self._ends if connection not in self._pages), None)
        if oldest is not None:
            _end(oldest)
            del self._ends[oldest]
        return oldest is not None

    def working(self, connection):
        """A page's request is being answered."""
        with self._lock:
            self._pages.add(connection)
            self._ends[connection] = None

    def waiting(self, connection):
        """It is answered."""
        with self._lock:
            if connection in self._ends:
                self._ends[connection] = time.monotonic() + IDLE

    def leave(self, connection):
        with self._lock:
            self._ends.pop(connection, None)
            self._pages.discard(connection)

    def _watch(self):
        while not self._stop.wait(1.0):
            with self._lock:
                now = time.monotonic()
                for connection, end in self._ends.items():
                    if end is not None and end < now:
                        _end(connection)

    def close(self):
        self._stop.set()


def _end(connection):
    """Whoever reads from it receives its end."""
    with suppress(OSError):
        connection.shutdown(SHUT_RDWR)


class Door(ThreadingHTTPServer):
    """A listening socket whose connections pass the gate."""

    daemon_threads = True
    block_on_close = False
    request_queue_size = BACKLOG

    def __init__(self, family, address, handler, gate):
        self.address_family, self.gate = family, gate
        super().__init__(address, handler)

    def server_bind(self):
        """Without a look-up of this machine's name."""
        self.socket.setsockopt(SOL_SOCKET, SO_REUSEADDR, 1)
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_port = self.server_address[1]

    def get_request(self):
        try:
            return super().get_request()
        except OSError:
            self.gate.make_way()
            time.sleep(0.05)
            raise

    def verify_request(self, request, client_address):
        return self.gate.enter(request)

    def shutdown_request(self, request):
        self.gate.leave(request)
        super().shutdown_request(request)

    def handle_error(self, request, client_address):
        """Nothing: the connection has gone."""
