"""What a Python session asks of the program: a run, a check, single starts, one orbit, a sweep."""

import json
import os
import signal
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kapitza import units
from kapitza.program import STOPPED, ask, check_end, command, environment
from kapitza.progress import Progress
from kapitza.result import Result
from kapitza.scene import Scene, SceneLike, new_path


def run(scene: SceneLike, output: str | os.PathLike[str] | None = None, ranks: int = 1,
        set: Mapping[str, Any] | None = None,
        resume: bool = False, progress: bool = True, *, method: str | None = None, force: bool = False) -> Result:
    """Models every study of a scene and returns its Result.

    Ctrl-C stops the run. The checkpoint of `output` then keeps the finished work.

    :param scene: path of a scene file, YAML text, or a mapping
    :param output: name of the result file; None = a temporary file that is removed at the end of the session
    :param ranks: number of MPI processes
    :param set: keys to change, such as `{"basin.theta.count": 200}`. A key of `pendulum` may stand alone,
        `{"drive_amplitude": 0.4}`; a mapping such as `{"pendulum": {"drive_amplitude": 0.4}}` is merged with that of
        the scene, key by key
    :param resume: continue from the checkpoint of `output`; if `output` is complete for this scene, read it
    :param progress: whether to show a progress bar
    :param method: `basin.method`: "exact", "direct" or "icm"
    :param force: overwrite `output`
    :raises SceneError: if the program refuses the scene
    :raises RunError: if the run fails later
    """
    asked = Scene(scene, set, method)
    path = Path(output) if output is not None else new_path(f"{asked.stem}.h5")
    words: list[str | os.PathLike[str]] = ["run", asked.path if asked.is_file else "-", *asked.sets, "-o", path,
                                           "--progress", "never"]
    words += ["--resume"] * resume + ["--force"] * force
    with tempfile.TemporaryDirectory(prefix="kapitza-run-") as folder:
        log = Path(folder) / "log"
        summary = _follow(command([*words, "--log", log], ranks), asked, path, output is not None,
                          Progress(log, progress), Path(folder))
    result = Result(path)
    result.summary = summary
    return result


def _follow(line: list[str], scene: Scene, path: Path, named: bool, progress: Progress, folder: Path) -> str:
    """Runs the command to its end and returns what it printed. Ctrl-C asks the program to stop; a second one kills
    it."""
    interrupted = False
    with (folder / "in").open("w+") as words, (folder / "out").open("w+") as out, (folder / "err").open("w+") as err:
        words.write("" if scene.is_file else scene.text)
        words.seek(0)
        process = subprocess.Popen(line, stdin=words, stdout=out, stderr=err, env=environment(), start_new_session=True)
        try:
            while process.poll() is None:
                try:
                    process.wait(0.1)
                except subprocess.TimeoutExpired:
                    progress.look()
                except KeyboardInterrupt:
                    if interrupted:
                        raise
                    interrupted = True
                    process.send_signal(signal.SIGUSR1)
        finally:
            progress.close()
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        out.seek(0)
        err.seek(0)
        if interrupted:
            raise KeyboardInterrupt(_interrupted(process.returncode, path, named))
        check_end(process.returncode, err.read(), scene)
        return out.read()


def _interrupted(status: int, path: Path, named: bool) -> str:
    if status == 0:
        return f"the run had just ended: {path} is complete"
    if status == STOPPED and named:
        return f"stopped; finished work is kept in {path}.checkpoint, and resume=True goes on from it"
    return "stopped" + ("" if named else "; give an output to keep finished work")


@dataclass(frozen=True)
class Check:
    """What a run of a scene would model, and its cost. `text` is what the command `check` prints.

    `scene` is YAML with every default, `studies` the names of the studies, and `cells` the number of cells.
    """

    scene: str
    studies: list[str]
    cells: int
    text: str

    def __repr__(self) -> str:
        return self.text


def check(scene: SceneLike, set: Mapping[str, Any] | None = None) -> Check:
    """Returns what a run of the scene would model, and what it would cost. It models and writes nothing.

    :param scene: path of a scene file, YAML text, or a mapping
    :param set: keys to change
    :raises SceneError: if the program refuses the scene
    """
    asked = Scene(scene, set)
    facts = json.loads(ask(["check", asked.path, *asked.sets, "--json"], asked))
    return Check(facts["scene"], facts["studies"], facts["cells"], facts["text"])


def orbit(scene: SceneLike, theta: Any = None, velocity: Any = None, *, attractor: int | str | None = None,
          periods: int | None = None,
          transient: int = 0, closed: bool = False, set: Mapping[str, Any] | None = None,
          progress: bool = True) -> Result:
    """Models one motion of the scene's pendulum, from a start or along an attractor.

    `result.group("orbit")` has time, theta, velocity, strobe points and spectral lines.

    :param theta: angle of the start, rad from down, or a text such as "175 deg" or "pi/2"
    :param velocity: velocity of the start, rad per drive radian, or, for a scene in SI units, a text such as "3 rad/s"
    :param attractor: id or name of an attractor of the scene's basin, instead of a start
    :param periods: number of recorded drive periods
    :param transient: number of drive periods before the record
    :param closed: record the cycle near the start instead of the motion from it
    """
    asked = Scene(scene, set)
    plan: dict[str, Any] = {"transient": transient, "closed": closed}
    kept = ["title", "pendulum", "numerics"]
    if attractor is not None:
        kept += ["basin", "attractors"]
        plan = {"attractor": _attractor_id(asked, attractor)}
    elif theta is None or velocity is None:
        raise ValueError("give theta and velocity, or an attractor")
    else:
        omega = units.written_frequency(asked.value("pendulum") or {})
        plan["start"] = {"theta": units.angle(theta), "velocity": units.velocity(velocity, omega)}
    if periods is not None:
        plan["periods"] = periods
    return run({name: value for name, value in asked.tree().items() if name in kept and value != ""} | {"orbit": plan},
               progress=progress)


def _attractor_id(scene: Scene, wanted: int | str) -> int:
    """The id of an attractor of the scene's basin by its id or name; the first of a name."""
    if isinstance(wanted, int):
        return wanted
    found = run(scene, set={"basin.method": "direct"}, progress=False).attractors
    ids = found.index[found["name"] == wanted]
    if len(ids) == 0:
        raise ValueError(f"{wanted!r} is not an attractor of the scene; its attractors are "
                         f"{', '.join(dict.fromkeys(found['name']))}")
    return int(ids[0])


def sweep(scene: SceneLike, parameter: str, values: Iterable[Any] | Mapping[str, Any],
          measure: str | Iterable[str] = ("attractors", "basin_fractions"), *, ranks: int = 1,
          output: str | os.PathLike[str] | None = None, progress: bool = True, **keys: Any) -> Result:
    """Follows the attractors along one key of the pendulum, in the window of the scene's basin if it has one.

    `result.group("sweep")` has the numbers. Every study of the scene runs, as it does from the command line.

    :param parameter: key of the mapping `pendulum`, such as "drive_amplitude" or "pendulum.drive_amplitude"
    :param values: the values, ascending, at most 256; or a range `{"min": 0.1, "max": 0.5, "count": 50}`, both ends
        included
    :param measure: one or several measures of the study `sweep`, such as "attractors", "basin_fractions" or
        "release_angle"
    :param ranks: number of MPI processes
    :param output: name of the result file; None = a temporary file
    :param keys: further keys of the study `sweep`, such as `starts=4096`
    """
    if isinstance(values, str) or isinstance(measure, int) or "count" in keys:
        raise TypeError('values are a list such as [0.1, 0.2, 0.5], or a range {"min": 0.1, "max": 0.5, "count": 50}')
    asked = Scene(scene)
    plan = {"parameter": parameter, **(values if isinstance(values, Mapping) else {"values": list(values)}),
            "measure": [measure] if isinstance(measure, str) else list(measure), **keys}
    return run(asked.tree() | {"sweep": plan}, output, ranks, progress=progress)
