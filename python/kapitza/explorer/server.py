"""The explorer's server: loopback addresses only, a token in every request, small requests, answers as they come."""

import json
import socket
import sys
import threading
from http.server import BaseHTTPRequestHandler
from pathlib import Path

from kapitza.result import BadFile

from .access import Access
from .answers import ANSWERS, RUNS, page_folder
from .colours import Colours
from .connections import Door, Gate
from .process import Refused, Views
from .requests import BadRequest, Engine
from .run_cache import RunCache
from .scene import Start

MOST_BYTES = 65_536  # longest request
MOST_NAME = 64       # characters of a view's name
KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
FIRST = "first"      # the view that is begun before a page comes


class Explorer:
    """The server with its views. `program`: the executable of maps and saddles; `origins`: of pages that may ask beside
    its own; `frames`: that may show it in a frame; `engine`: what makes the engine of a view."""

    def __init__(self, start: Start, program, port=0, origins=(), frames=(), engine=Engine):
        self.start, self.views = start, Views(start.engine(), _coloured, engine)
        self.kept = RunCache(program, start.tree.get("numerics"))
        self.files = {path.name: path.read_bytes() for path in page_folder().iterdir() if path.suffix in KINDS}
        self.access, self.frames = Access(origins), tuple(frames)
        try:
            self.views.view(FIRST)
            self.gate = Gate()
            self._doors = _doors(port, self.gate, type("Connected", (Handler,), {"explorer": self}))
        except BaseException:
            self.views.close()
            raise
        self.on_trade = lambda: None  # called when a page has come
        self._threads = [threading.Thread(target=door.serve_forever, daemon=True) for door in self._doors]

    @property
    def port(self):
        return self._doors[0].server_port

    @property
    def title(self):
        return self.start.tree.get("title") or self.start.name

    def new_address(self, base=None):
        """An address that is good for one browser."""
        return f"{base or f'http://127.0.0.1:{self.port}/'}?once={self.access.new_address()}"

    def serve(self):
        for thread in self._threads:
            thread.start()

    def close(self):
        """Ends every engine, run and connection."""
        self.kept.close()
        self.views.close()
        for door in self._doors:
            door.shutdown()
            door.server_close()
        self.gate.close()


def _coloured():
    """What adds colours to the catalogues of a view."""
    colours = Colours()

    def add(catalogue):
        catalogue["attractors"] = colours.added(catalogue["attractors"])
    return add


def _doors(port, gate, handler):
    """Listening sockets on 127.0.0.1 and, where this machine has it, [::1]: nobody else shall have the same port
    there."""
    for attempt in range(20):
        first = Door(socket.AF_INET, ("127.0.0.1", port), handler, gate)
        try:
            return [first, Door(socket.AF_INET6, ("::1", first.server_port), handler, gate)]
        except OSError as error:
            if error.errno not in (98,) or (port == 0 and attempt == 19):
                return [first]
            if port != 0:
                first.server_close()
                raise
            first.server_close()
    raise AssertionError("unreachable")


class Handler(BaseHTTPRequestHandler):
    """GET: the page's files. POST: `token` and `close`, which bring their token in the body; `ask?view=NAME` and what
    RUNS holds, whose answers are passed on as they come; and what ANSWERS holds."""

    explorer: Explorer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "kapitza", ""

    def log_message(self, *arguments):
        """Nothing: what a person should know stands on the page."""

    def handle(self):
        try:
            super().handle()
        except (OSError, ValueError):
            pass  # the connection has gone, or is ended by the gate

    def do_GET(self):
        self.close_connection = True  # files are for strangers too: their connections do not stay
        name = self.path.partition("?")[0].lstrip("/") or "index.html"
        if not self.explorer.access.knows(self.headers.get("Host"), self.headers.get("Origin")):
            self._refuse(403, "foreign host or origin")
        elif name in self.explorer.files:
            self._send(200, self.explorer.files[name], f"{KINDS[Path(name).suffix]}; charset=utf-8")
        else:
            self._refuse(404, "no such page")

    def do_POST(self):
        name, _, query = self.path.partition("?")
        name = name.lstrip("/")
        try:
            if not self.explorer.access.knows(self.headers.get("Host"), self.headers.get("Origin")):
                raise PermissionError(
                    "this page comes from another origin; start kapitza view with --origin to allow it")
            if name == "token":
                return self._trade(self._request())
            if name == "close":
                return self._close(self._request())
            self._check(self.headers.get("X-Kapitza-Token", ""))
            self._answer(name, query)
        except PermissionError as error:
            self._refuse(403, str(error))
        except (BadRequest, Refused, BadFile) as error:
            self._refuse(400, str(error))
        except (OSError, TimeoutError):
            raise
        except Exception as error:  # a fault of ours: one line, and the server goes on
            print(f"kapitza: error: view: {type(error).__name__}: {error}", file=sys.stderr, flush=True)
            self._refuse(500, "the explorer's server failed; its terminal says where")
        finally:
            self.explorer.gate.waiting(self.connection)

    def _check(self, token):
        if not self.explorer.access.admits(token):
            raise PermissionError("the token is wrong; open the address that kapitza view has printed")
        self.explorer.gate.working(self.connection)

    def _trade(self, request):
        token = self.explorer.access.trade(request.get("once"))
        if token is None:
            raise PermissionError("this address has been used; open the newest address in the terminal")
        self._send_json(200, {"token": token})
        self.explorer.on_trade()

    def _close(self, request):
        self._check(request.get("token"))
        self.explorer.views.close(str(request.get("view")))
        self._send_json(200, {})

    def _answer(self, name, query):
        request = self._request()
        if name == "ask" and query.startswith("view=") and len(query) <= MOST_NAME:
            self._pass_on(self._asked(query.removeprefix("view="), request))
        elif name in RUNS:
            self._pass_on(RUNS[name](self.explorer.kept, request))
        elif name in ANSWERS:
            self._send_json(200, ANSWERS[name](self.explorer, request))
        else:
            self._refuse(404, "no such request")

    def _asked(self, view, request):
        self.explorer.views.rename(FIRST, view)
        if "atlas" in request:  # the page knows files by name alone, and one may have gone
            path = self.explorer.kept.path(request["atlas"])
            rest = {key: value for key, value in request.items() if key not in ("atlas", "x", "y")}
            request = rest if path is None else request | {"atlas": path}
        return self.explorer.views.answers(view, request)

    def _pass_on(self, answers):
        """Answers, each as a chunk: header, line feed, bytes. What goes wrong after the first one is the last."""
        try:
            first = next(answers)
            self._begin(200, {"Content-Type": "application/octet-stream", "Transfer-Encoding": "chunked"})
            self._chunk(*first)
            try:
                for answer in answers:
                    self._chunk(*answer)
            except Refused as error:
                self._chunk({"answer": "error", "final": True, "bytes": 0, "status": 2, "message": str(error)}, b"")
            self.wfile.write(b"0\r\n\r\n")
        finally:
            answers.close()

    def _chunk(self, header, payload):
        line = json.dumps(header, ensure_ascii=False).encode() + b"\n"
        self.wfile.write(b"%x\r\n" % (len(line) + len(payload)) + line + payload + b"\r\n")

    def _request(self):
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdigit() and len(length) < 7 and int(length) <= MOST_BYTES):
            self.close_connection = True
            raise BadRequest(f"a request must give its length, at most {MOST_BYTES} bytes")
        try:
            request = json.loads(self.rfile.read(int(length)))
        except (ValueError, RecursionError) as error:
            raise BadRequest("the request is not JSON") from error
        if not isinstance(request, dict):
            raise BadRequest("the request is not a JSON object")
        return request

    def _refuse(self, status, message):
        self.close_connection = True  # the rest of the request is not read
        self._send_json(status, {"error": message})

    def _send_json(self, status, answer):
        self._send(status, json.dumps(answer).encode(), "application/json")

    def _send(self, status, body, kind):
        self._begin(status, {"Content-Type": kind, "Content-Length": str(len(body))})
        self.wfile.write(body)

    def _begin(self, status, headers):
        frames = " ".join(self.explorer.frames)
        fixed = {"Cache-Control": "no-store", "Referrer-Policy": "no-referrer", "X-Content-Type-Options": "nosniff",
                 "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src data: "
                                            "blob:; "
                 "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors "
                 f"{frames or chr(39) + 'none' + chr(39)}"}
        if not frames:
            fixed["X-Frame-Options"] = "DENY"
        if self.close_connection:
            fixed["Connection"] = "close"
        self.send_response(status)
        for name, value in (headers | fixed).items():
            self.send_header(name, value)
        self.end_headers()
