"""What a Python session asks of the program: a run, a check, single starts, one orbit, a sweep."""

import json
import os
import re
import signal
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from kapitza.program import STOPPED, ask, check_end, command, environment
from kapitza.progress import Progress
from kapitza.result import Result
from kapitza.scene import Scene, SceneLike, new_path, texts


def run(scene: SceneLike, output: str | os.PathLike[str] | None = None, ranks: int = 1, set: Mapping[str, Any] | None = None,
        resume: bool = False, progress: bool = True, *, method: str | None = None, force: bool = False) -> Result:
    """Models every study of a scene and returns its Result.

    scene: path of a scene file, YAML text, or a mapping. output: the result file; None = one that lasts as long as the session.
    ranks: MPI processes. set: keys to change, such as {"basin.theta.count": 200}. resume: continue from output's checkpoint, or take a
    complete output of this scene as it is. progress: whether a bar shows. method: basin.method. force: overwrite output.
    Ctrl-C stops the run and keeps what is finished in the checkpoint of `output`. Raises SceneError if the program refuses the scene, and
    RunError if the run fails later.
    """
    asked = Scene(scene, set, method)
    path = Path(output) if output is not None else new_path(f"{asked.stem}.h5")
    words: list[str | os.PathLike[str]] = ["run", asked.path if asked.is_file else "-", *asked.sets, "-o", path, "--progress", "never"]
    words += ["--resume"] * resume + ["--force"] * force
    with tempfile.TemporaryDirectory(prefix="kapitza-run-") as folder:
        log = Path(folder) / "log"
        summary = _follow(command([*words, "--log", log], ranks), asked, path, output is not None, Progress(log, progress), Path(folder))
    result = Result(path)
    result.summary = summary
    return result


def _follow(line: list[str], scene: Scene, path: Path, named: bool, progress: Progress, folder: Path) -> str:
    """Runs the command to its end and returns what it printed. Ctrl-C asks the program to stop; a second one kills it."""
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
    """What a scene would model: `scene` with every default, `studies`, `cells`, `seconds` on one core (a lower bound where the
    page says "more than"); `text`: the program's page."""

    scene: str
    studies: list[str]
    cells: int
    seconds: float
    text: str

    def __repr__(self) -> str:
        return self.text


def check(scene: SceneLike, set: Mapping[str, Any] | None = None) -> Check:
    """What a run of the scene would model and cost. Raises SceneError if a run would be refused. Nothing is modelled or written."""
    asked = Scene(scene, set)
    text = ask(["check", asked.path, *asked.sets], asked)
    facts = {name: value for name, value in re.findall(r"^(studies|cells|estimated time) +(.*)$", text, re.MULTILINE)}
    number, unit = facts["estimated time"].removeprefix("more than ").split()[:2]
    seconds = float(number) * {"s": 1, "min": 60, "h": 3600}[unit]
    return Check(text.split("\n\n")[1] + "\n", facts["studies"].split(), int(facts["cells"]), seconds, text)


def where(scene: SceneLike, theta: Any, velocity: Any, set: Mapping[str, Any] | None = None) -> pandas.DataFrame:
    """Where starts end: a row for each start, in the order of the broadcast arrays `theta` (rad from down) and `velocity` (rad per
    drive radian).

    Both take numbers, or texts such as "175 deg", "pi/2" and, of a scene in SI units, "3 rad/s"; up to 100,000 starts.
    Columns: theta, velocity, attractor (-1: not settled), name, period (0: chaotic), winding, settling_time (drive periods), decided,
    strobe_theta and strobe_velocity (lists), precision, error (rad), other_attractor, other_name; missing where there is none. Of a
    scene in SI units also velocity_rad_per_s, settling_seconds, strobe_velocity_rad_per_s.
    """
    asked = Scene(scene, set)
    angles, velocities = (np.ravel(values) for values in np.broadcast_arrays(_starts(theta), _starts(velocity)))
    table = "".join(f"{angle},{speed}\n" for angle, speed in zip(angles, velocities, strict=True))
    rows = [json.loads(line) for line in ask(["where", asked.path, "-", *asked.sets, "--json"], asked, table).splitlines()]
    return pandas.DataFrame(rows).astype({name: "Int64" for name in ("period", "winding", "settling_time")})


def _starts(values: Any) -> np.ndarray:
    """Numbers as texts that read back as the same numbers, and texts as they are; of any shape."""
    given = np.asarray(values, dtype=object)
    return np.vectorize(texts, otypes=[object])(given) if given.size else given


def orbit(scene: SceneLike, theta: Any = None, velocity: Any = None, *, attractor: int | str | None = None, periods: int | None = None,
          transient: int = 0, closed: bool = False, set: Mapping[str, Any] | None = None, progress: bool = True) -> Result:
    """One motion of the scene's pendulum: result.group("orbit") has time, theta, velocity, strobe points, spectral lines.

    It starts at (theta, velocity), or runs along an attractor of the scene's basin (its id or name). periods: drive periods
    that are recorded, after `transient` of them; closed: the cycle near the start instead of the motion from it.
    """
    asked = Scene(scene, set)
    plan: dict[str, Any] = {"start": {"theta": theta, "velocity": velocity}, "transient": transient, "closed": closed}
    kept = ["title", "pendulum", "numerics"]
    if attractor is not None:
        kept += ["basin", "attractors"]
        plan = {"attractor": _attractor_id(asked, attractor)}
    elif theta is None or velocity is None:
        raise ValueError("give theta and velocity, or an attractor")
    if periods is not None:
        plan["periods"] = periods
    return run(_only(asked, kept) | {"orbit": plan}, progress=progress)


def _attractor_id(scene: Scene, wanted: int | str) -> int:
    """The id of an attractor of the scene's basin by its id or name; the first of a name."""
    if isinstance(wanted, int):
        return wanted
    found = run(scene, set={"basin.method": "direct"}, progress=False).attractors
    ids = found.index[found["name"] == wanted]
    if len(ids) == 0:
        raise ValueError(f"{wanted!r} is not an attractor of the scene; its attractors are {', '.join(dict.fromkeys(found['name']))}")
    return int(ids[0])


def sweep(scene: SceneLike, parameter: str, values: tuple[Any, Any], count: int = 50,
          measure: str | Iterable[str] = ("attractors", "basin_fractions"), *, ranks: int = 1,
          output: str | os.PathLike[str] | None = None, progress: bool = True, **keys: Any) -> Result:
    """The attractors along one key of the pendulum, at `count` values from values[0] to values[1].

    measure: one or several of those of the study sweep (attractors, basin_fractions, flutter_amplitude, release_angle, strobe,
    ...); keys: its other keys, such as starts=4096. result.group("sweep") has the numbers.
    """
    asked = Scene(scene)
    plan = {"parameter": parameter, "min": values[0], "max": values[1], "count": count,
            "measure": [measure] if isinstance(measure, str) else list(measure), **keys}
    return run(_only(asked, ["title", "pendulum", "numerics"]) | {"sweep": plan}, output, ranks, progress=progress)


def _only(scene: Scene, kept: list[str]) -> dict[str, Any]:
    """The scene with these of its mappings alone."""
    return {name: value for name, value in scene.tree().items() if name in kept}
