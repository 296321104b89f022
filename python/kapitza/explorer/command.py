"""The command `kapitza view SCENE|FILE`. The program's own command line calls it and has its help."""

import argparse
import os
import signal
import socket
import sys
import threading
import webbrowser

from kapitza.exit_status import words_of
from kapitza.program import program
from kapitza.result import BadFile

from .access import WrongArgument, origin
from .process import Refused
from .requests import Engine
from .scene import Start
from .server import Explorer


def _arguments():
    parser = argparse.ArgumentParser(prog="kapitza view", description=__doc__)
    parser.add_argument("file", metavar="SCENE|FILE")
    parser.add_argument("--port", default="0", help="of the local server; 0 = any that is free")
    parser.add_argument("--origin", action="append", default=[],
                        help="of other pages' servers (https://hub.example.org)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                        help="override or create a key of the scene")
    parser.add_argument("--no-browser", action="store_true", help="print the address, and do not open a browser")
    return parser.parse_args(words_of(["--no-browser"]))


def _port(text):
    """A port that a user may take; 0: any that is free."""
    if not (text.isascii() and text.isdigit() and len(text) <= 5) or not (int(text) == 0 or 1024 <= int(text) <= 65535):
        raise WrongArgument(
            f"--port: {text} is not a port; it must be a number from 1024 to 65535, or 0 for any that is free")
    return int(text)


def main(engine=Engine):
    """Errors are one line, as the program's own are. `engine`: what makes the engine of a view."""
    try:
        _main(_arguments(), engine)
    except (BadFile, WrongArgument) as error:
        print(f"kapitza: error: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:  # the address could not be printed: a full disk, a closed pipe
        print(f"kapitza: error: view: {error.strerror or error}", file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the rest would fail again at the end
        sys.exit(1)


def _main(given, engine):
    port, origins = _port(given.port), [origin(text) for text in given.origin]
    try:
        explorer = Explorer(Start(given.file, sets=given.set), program(), port, origins, engine=engine)
    except Refused as error:
        raise WrongArgument(str(error)) from error
    except OSError as error:
        raise WrongArgument(
            f"--port: {port} cannot be used: {error.strerror}; choose another, or leave it out") from error
    _serve(explorer, not given.no_browser)


def _serve(explorer, opens):
    """Until SIGINT, SIGTERM or SIGHUP."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: stop.set())
    explorer.serve()
    try:
        explorer.on_trade = lambda: print(f"for another browser: {explorer.new_address()}", flush=True)
        print(f"{explorer.title}\n{explorer.new_address()}\nEach address serves one browser. Ctrl-C ends it.",
              flush=True)
        if not opens or not webbrowser.open(explorer.new_address()):
            forward = f"ssh -L {explorer.port}:127.0.0.1:{explorer.port} {socket.gethostname()}"
            print(f"Open it in a browser here; on another machine first: {forward}", flush=True)
        stop.wait()
    finally:
        explorer.close()
