"""The command `kapitza view SCENE|FILE`. The program's own command line calls it and has its help."""

import argparse
import signal
import socket
import threading
import webbrowser
from pathlib import Path

from .access import WrongArgument, origin
from .program import Refused
from .scene import Start
from .server import Explorer


def _arguments():
    parser = argparse.ArgumentParser(prog="kapitza view", description=__doc__)
    parser.add_argument("file", metavar="SCENE|FILE")
    parser.add_argument("--program", type=Path, required=True, help="the executable that computes")
    parser.add_argument("--port", default="0", help="of the local server; 0 = any that is free")
    parser.add_argument("--origin", action="append", default=[], help="of other pages' servers (https://hub.example.org)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override or create a key of the scene")
    parser.add_argument("--browser", action=argparse.BooleanOptionalAction, default=True, help="open the address in the browser")
    return parser.parse_args()


def _port(text):
    """A port that a user may take; 0: any that is free."""
    if not (text.isascii() and text.isdigit() and len(text) <= 5) or not (int(text) == 0 or 1024 <= int(text) <= 65535):
        raise WrongArgument(f"--port: {text} is not a port; it must be a number from 1024 to 65535, or 0 for any that is free")
    return int(text)


def main():
    given = _arguments()
    port, origins = _port(given.port), [origin(text) for text in given.origin]
    try:
        explorer = Explorer(Start(given.file, sets=given.set), given.program, port, origins)
    except Refused as error:
        raise WrongArgument(str(error)) from error
    except OSError as error:
        raise WrongArgument(f"--port: {port} cannot be used: {error.strerror}; choose another, or leave it out") from error
    _serve(explorer, given.browser)


def _serve(explorer, opens):
    """Until SIGINT, SIGTERM or SIGHUP."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: stop.set())
    explorer.serve()
    try:
        explorer.on_trade = lambda: print(f"for another browser: {explorer.new_address()}", flush=True)
        print(f"{explorer.title}\n{explorer.new_address()}\nEach address serves one browser. Ctrl-C ends it.", flush=True)
        if not opens or not webbrowser.open(explorer.new_address()):
            forward = f"ssh -L {explorer.port}:127.0.0.1:{explorer.port} {socket.gethostname()}"
            print(f"Open it in a browser here; on another machine first: {forward}", flush=True)
        stop.wait()
    finally:
        explorer.close()
