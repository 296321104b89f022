"""kapitza.explore: the explorer in a cell of a notebook, reached directly, under another port, and through a proxy with
a prefix."""

import json
import re
import threading
import urllib.error
import urllib.request
from contextlib import contextmanager
from html import unescape
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import kapitza
import pytest
from conftest import ROOT
from explorer_page import Page, browser

SMALL = ROOT / "scenes" / "small.yaml"
HUB = "/user/me/"


@pytest.fixture(scope="module")
def shown():
    cell = kapitza.explore(SMALL, set={"pendulum.drive_amplitude": 0.35})
    yield cell
    cell.close()


def address_of(cell):
    """What the cell's frame shows."""
    return unescape(re.search('src="([^"]*)"', cell._repr_html_())[1])


def answer_of(request):
    try:
        with urllib.request.urlopen(request) as answer:
            return answer.status, dict(answer.headers), answer.read()
    except urllib.error.HTTPError as error:
        return error.code, dict(error.headers), error.read()


def test_a_cell_holds_the_page_which_pages_of_this_machine_may_frame(shown):
    address = address_of(shown)
    status, headers, text = answer_of(address)
    assert status == 200 and b"main.js" in text and address.startswith(f"http://127.0.0.1:{shown.port}/?once=")
    assert "X-Frame-Options" not in headers
    assert "frame-ancestors 'self' http://localhost:* http://127.0.0.1:*" in headers["Content-Security-Policy"]
    assert "[" not in headers["Content-Security-Policy"]  # browsers know no addresses of IPv6 there, and write an error
    assert address_of(shown) != address  # each address serves once


@contextmanager
def proxy(port, prefix):
    """A server proxy as of Jupyter: what stands behind `prefix` goes to the port."""
    class Proxy(BaseHTTPRequestHandler):
        def log_message(self, *arguments):
            pass

        def pass_on(self):
            body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
            headers = {name: value for name, value in self.headers.items()
                       if name not in ("Host", "Connection", "Accept-Encoding")}
            headers["Host"] = self.headers["Host"]
            assert self.path.startswith(prefix)
            own = f"http://127.0.0.1:{port}/{self.path.removeprefix(prefix)}"
            asked = urllib.request.Request(own, body or None, headers, method=self.command)
            status, said, text = answer_of(asked)
            self.send_response(status)
            for name in ("Content-Type", "Content-Security-Policy"):
                self.send_header(name, said[name])
            self.send_header("Content-Length", str(len(text)))
            self.end_headers()
            self.wfile.write(text)

        def do_GET(self):
            self.pass_on()

        def do_POST(self):
            self.pass_on()

    server = ThreadingHTTPServer(("127.0.0.1", 0), Proxy)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server.server_port
    server.shutdown()
    server.server_close()


def test_the_page_works_through_a_proxy_with_a_prefix_and_another_port(shown, tmp_path):
    with proxy(shown.port, f"{HUB}proxy/{shown.port}/") as port, browser(tmp_path, "600,420") as driver:
        address = address_of(shown).replace(f"127.0.0.1:{shown.port}/", f"localhost:{port}{HUB}proxy/{shown.port}/")
        page = Page(driver, address + "#samples=1&quality=moving")
        page.wait()
        assert page.run("explorer.state.pendulum.drive_amplitude") == "0.35" and len(page.shares()) > 3
        assert driver.current_url.startswith(f"http://localhost:{port}{HUB}proxy/{shown.port}/#")


def test_a_hub_must_be_named_and_is_then_let_in(monkeypatch):
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", HUB)
    with pytest.raises(ValueError, match="origins"):
        kapitza.explore(SMALL)
    cell = kapitza.explore("pendulum: {k: 0.1, damping: 0.05, m: 0.2}\n", origins=["https://hub.example.org"])
    try:
        address = address_of(cell)
        assert address.startswith(f"{HUB}proxy/{cell.port}/?once=")
        once = json.dumps({"once": address.partition("once=")[2]}).encode()
        for origin, status in (("https://evil.example.org", 403), ("https://hub.example.org", 200)):
            asked = urllib.request.Request(f"http://127.0.0.1:{cell.port}/token", once,
                                           {"Origin": origin, "Host": "hub.example.org"})
            assert answer_of(asked)[0] == status
    finally:
        cell.close()


def test_what_cannot_be_shown_is_said_in_python():
    with pytest.raises(kapitza.SceneError, match="drive_frequency"):
        kapitza.explore({"pendulum": {"quality_factor": 5, "drive_frequency": -1, "drive_amplitude": 0.3}})
    with pytest.raises(ValueError, match="frames: x is not an origin"):
        kapitza.explore(SMALL, frames=["x"])
    with pytest.raises(ValueError, match="hub is not an origin"):
        kapitza.explore(SMALL, origins=["hub"])
