"""The command `kapitza view SCENE|FILE`. The program's own command line calls it and has its help."""

import argparse
import signal
import sys
import threading
import webbrowser
from pathlib import Path

from .program import Program
from .scene import Start
from .server import Explorer


class WrongArgument(Exception):
    """An argument that cannot be used; the text names it and says what can."""


def _arguments():
    parser = argparse.ArgumentParser(prog="kapitza view", description=__doc__)
    parser.add_argument("file", metavar="SCENE|FILE")
    parser.add_argument("--program", type=Path, required=True, help="the executable that computes")
    parser.add_argument("--port", default="0", help="of the local server; 0 = any that is free")
    parser.add_argument("--browser", action=argparse.BooleanOptionalAction, default=True, help="open the address in the browser")
    return parser.parse_args()


def _port(text):
    """A port that a user may take; 0: any that is free."""
    if not text.isdigit() or not (int(text) == 0 or 1024 <= int(text) <= 65535):
        raise WrongArgument(f"--port: {text} is no port; it must be a number from 1024 to 65535, or 0 for any that is free")
    return int(text)


def main():
    given = _arguments()
    port, program = _port(given.port), Program(given.program)
    try:
        start = Start(given.file, program)
        try:
            server = Explorer(port, start, program)
        except OSError as error:
            raise WrongArgument(f"--port: {port} cannot be used: {error.strerror}; choose another, or leave it out") from error
        _serve(server, given.browser)
    finally:
        program.close()


def _serve(server, opens):
    """Until SIGINT, SIGTERM or SIGHUP."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: stop.set())
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        print(f"{server.start.title}\n{server.url}\nCtrl-C ends it.", flush=True)
        if opens and not webbrowser.open(server.url):
            print("no browser was found: open the address above in one", file=sys.stderr)
        stop.wait()
    finally:
        server.program.close()  # what computes ends now, and with it the request that waits for it
        server.shutdown()
        thread.join()
        server.server_close()
