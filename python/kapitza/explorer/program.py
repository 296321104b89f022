"""The program as the explorer runs it: one computation at a time; a new request ends the one before."""

import json
import os
import signal
import subprocess
import tempfile
import threading
from pathlib import Path

from kapitza.result import BadFile

SECONDS = 300  # after which a computation is given up


class Superseded(Exception):
    """A newer request has ended this one."""


class Refused(Exception):
    """The program's own message on why it did not compute."""


class Program:
    """Runs build/kapitza. Every request takes a ticket first; only the holder of the newest one may compute."""

    def __init__(self, path):
        self.path = Path(path)
        self._folder = tempfile.TemporaryDirectory(prefix="kapitza-view-")
        self._state, self._busy = threading.Lock(), threading.Lock()
        self._ticket, self._process, self._closed = 0, None, False

    def close(self):
        """Ends what runs and removes the temporary files."""
        with self._state:
            self._closed = True
            self._kill()
        with self._busy:
            self._folder.cleanup()

    def ticket(self):
        """The right to compute, which it takes from every other request."""
        with self._state:
            self._ticket += 1
            self._kill()
            return self._ticket

    def _kill(self):
        if self._process and self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)

    def _run(self, ticket, arguments, text):
        with self._busy:
            with self._state:
                if self._closed or ticket != self._ticket:
                    raise Superseded
                process = self._process = subprocess.Popen(
                    [self.path, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                    cwd=self._folder.name, start_new_session=True)
            try:
                output, errors = process.communicate(text, timeout=SECONDS)
            except subprocess.TimeoutExpired:
                with self._state:
                    self._kill()
                process.communicate()
                raise Refused(f"given up after {SECONDS} s") from None
            finally:
                with self._state:
                    self._process = None
        if process.returncode == -signal.SIGKILL and (self._closed or ticket != self._ticket):
            raise Superseded
        if process.returncode != 0:
            raise Refused(errors.strip().removeprefix("kapitza: error: ") or f"ended with status {process.returncode}")
        return output

    def run(self, ticket, scene):
        """The summary of a run, and the path of its result, which the caller removes."""
        path = Path(self._folder.name) / f"{ticket}.h5"
        output = self._run(ticket, ["run", "-", "-o", path, "--force", "--progress", "never"], json.dumps(scene))
        return output, path

    def where(self, ticket, scene, theta, velocity):
        """The JSON object of the command where."""
        return json.loads(self._run(ticket, ["where", "-", repr(theta), repr(velocity), "--json"], json.dumps(scene)))

    def resolved(self, path):
        """The scene of a file with every default, as the program prints it."""
        done = subprocess.run([self.path, "check", path], capture_output=True, text=True, timeout=SECONDS)
        if done.returncode != 0:
            raise BadFile(done.stderr.strip().removeprefix("kapitza: error: "))
        return done.stdout.split("\n\n")[1]

    def methods(self):
        """The words of the key basin.method."""
        done = subprocess.run([self.path, "keys", "--json-schema"], capture_output=True, text=True, timeout=SECONDS, check=True)
        scene = json.loads(done.stdout)["allOf"][0]
        return scene["properties"]["basin"]["properties"]["method"]["enum"]
