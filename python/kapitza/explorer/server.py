"""The explorer's server: 127.0.0.1 only, a token in every request, small requests, nothing from the network."""

import json
import secrets
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from urllib.parse import parse_qs, urlsplit

from kapitza.result import BadFile

from . import views
from .program import Refused, Superseded
from .scene import BadRequest, block_text

MOST_BYTES = 20_000  # of a request
SCRIPTS = ("surface.js", "map.js", "pendulum.js", "explorer.js", "controls.js")


def page():
    """The page with its style and scripts: one self-contained file."""
    folder = files(__package__).joinpath("page")
    def text(name):
        return folder.joinpath(name).read_text(encoding="utf-8")
    whole = text("page.html").replace("/* style.css */", text("style.css"))
    return whole.replace("/* scripts */", '"use strict";\n' + "\n".join(map(text, SCRIPTS)))


class Explorer(ThreadingHTTPServer):
    """What the handlers share."""

    daemon_threads = True

    def __init__(self, port, start, program):
        super().__init__(("127.0.0.1", port), Handler)
        self.start, self.program = start, program
        self.token = secrets.token_urlsafe(32)
        self.methods = program.methods()
        self.page = page()

    @property
    def address(self):
        return f"127.0.0.1:{self.server_port}"

    @property
    def url(self):
        return f"http://{self.address}/?token={self.token}"


def state(server, request):
    """What the page needs before its first view."""
    start = server.start
    return {"title": start.title, "window": start.window, "sliders": start.sliders, "methods": server.methods,
            "overlays": views.overlays(start.result)}


def view(server, request):
    """The labels of one view."""
    scene = server.start.view(request, server.methods)
    summary, path = server.program.run(server.program.ticket(), scene)
    try:
        return views.view(path) | {"summary": summary, "window": request["window"], "method": scene["basin"]["method"]}
    finally:
        path.unlink(missing_ok=True)


def start(server, request):
    """Where a start ends, and the motion until a few periods after it has settled."""
    scene = server.start.view(request, server.methods)
    server.start.orbit(request, 1)  # refuses a start that is none
    ticket = server.program.ticket()
    ending = server.program.where(ticket, scene, float(request["theta"]), float(request["velocity"]))
    orbit = server.start.orbit(request, (ending["settling_time"] or 0) + 4 * (ending["period"] or 1) + 8)
    _, path = server.program.run(ticket, orbit)
    try:
        return {"ending": ending, "motion": views.motion(path)}
    finally:
        path.unlink(missing_ok=True)


def scene(server, request):
    """The view as the text of a scene."""
    return {"text": block_text(server.start.view(request, server.methods))}


ANSWERS = {"/state": state, "/view": view, "/start": start, "/scene": scene}


class Handler(BaseHTTPRequestHandler):
    """GET / is the page, POST /NAME a JSON object that is answered by one."""

    protocol_version = "HTTP/1.1"
    timeout = 60

    def log_message(self, *arguments):
        """Nothing: what a person should know stands on the page."""

    def do_GET(self):
        target = urlsplit(self.path)
        given = parse_qs(target.query).get("token", [""])[0]
        if target.path != "/":
            self._refuse(404, "no such page")
        elif self._is_ours(given):
            self._send(200, self.server.page.encode(), "text/html; charset=utf-8")

    def do_POST(self):
        answer = ANSWERS.get(self.path)
        if not self._is_ours(self.headers.get("X-Kapitza-Token", "")):
            return
        if answer is None:
            self._refuse(404, "no such request")
            return
        try:
            self._send_json(200, answer(self.server, self._request()))
        except Superseded:
            self._refuse(409, "a newer request has ended this one")
        except (BadRequest, Refused, BadFile) as error:
            self._refuse(400, str(error))

    def _is_ours(self, token):
        """Whether host, origin and token are those of this server's own page; else they are refused."""
        origin = self.headers.get("Origin")
        if self.headers.get("Host") != self.server.address or origin not in (None, f"http://{self.server.address}"):
            self._refuse(403, "foreign origin")
        elif not secrets.compare_digest(token.encode(), self.server.token.encode()):
            self._refuse(403, "wrong token: open the address that kapitza view has printed")
        else:
            return True
        return False

    def _request(self):
        length = self.headers.get("Content-Length", "")
        if not length.isdigit() or int(length) > MOST_BYTES:
            self.close_connection = True
            raise BadRequest(f"a request has a length, of at most {MOST_BYTES} bytes")
        try:
            request = json.loads(self.rfile.read(int(length)))
        except ValueError as error:
            raise BadRequest("a request is JSON") from error
        if not isinstance(request, dict):
            raise BadRequest("a request is a JSON object")
        return request

    def _refuse(self, status, message):
        self.close_connection = True  # what the request still holds is not read
        self._send_json(status, {"error": message})

    def _send_json(self, status, answer):
        self._send(status, json.dumps(answer).encode(), "application/json")

    def _send(self, status, body, kind):
        headers = {"Content-Type": kind, "Content-Length": len(body), "Cache-Control": "no-store", "Referrer-Policy": "no-referrer",
                   "X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY",
                   "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                                              "img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'"}
        if self.close_connection:
            headers["Connection"] = "close"
        try:
            self.send_response(status)
            for name, value in headers.items():
                self.send_header(name, str(value))
            self.end_headers()
            self.wfile.write(body)
        except ConnectionError:
            self.close_connection = True  # the page has left
