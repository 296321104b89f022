"""The program behind the package: where it is, how it is started, and what its refusals become in Python."""

import importlib.metadata
import os
import re
import shutil
import subprocess
import warnings
from collections.abc import Sequence
from numbers import Integral
from pathlib import Path
from typing import Any

from kapitza.scene import Scene, passed_on

# Settings of mpirun in containers and on small machines: root may run it, and ranks may outnumber cores. Variables,
# because every MPI has other options for it (OMPI: Open MPI 4; PRTE: Open MPI 5; MPICH needs none).
MPI_SETTINGS = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_orte_execute_quiet": "1", "OMPI_MCA_mpi_yield_when_idle": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
}
# Variables of launchers that children of a process must not take for their own, and those that show a process of a job.
JOB_SETTINGS = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_", "HYDI_", "HYDRA_", "MPI_LOCAL", "SLURM_")
IN_A_JOB = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_STEP_ID"}
FEWEST_MOST_RANKS, RANKS_PER_CORE = 64, 8
REFUSED, STOPPED = 2, 75  # exit statuses
MOST_BYTES = 1_000_000  # largest scene
ERROR = "kapitza: error: "  # begins every line of the program that is an error
_PLACE = re.compile(r"(?P<place>(?:.+?:\d+:\d+|--set .+?|request)): (?P<key>[a-z_]\w*(?:\.\w+)*): ")


class SceneError(ValueError):
    """The program refuses a scene or a command. The text is the program's message.

    `key` is the key of the scene that is wrong, or None if it is not a single one. `value` is its value; None = the key
    is missing. `place` is the place in the scene: `FILE:LINE:COLUMN`, "line LINE, column COLUMN" in a text, or the
    option that set the key.
    """

    def __init__(self, text: str, key: str | None = None, value: Any = None, place: str | None = None) -> None:
        super().__init__(text)
        self.key, self.value, self.place = key, value, place


class RunError(RuntimeError):
    """A run has failed. The text is the program's message."""


def version() -> str:
    """The version of this package: that of the sources around it, or of its installation."""
    sources = Path(__file__).resolve().parents[2] / "CMakeLists.txt"
    if sources.is_file() and (found := re.search(r"project\(kapitza VERSION ([0-9.]+)", sources.read_text())):
        return found[1]
    return importlib.metadata.version("kapitza")


def program() -> Path:
    """The program: the variable KAPITZA, else that of the sources around this package, of its installation, or on the
    PATH."""
    if chosen := os.environ.get("KAPITZA"):
        return Path(chosen)
    built = Path(__file__).resolve().parents[2] / "build" / "kapitza"
    if built.is_file() and (built.parents[1] / "CMakeLists.txt").is_file():
        return built
    try:
        files = importlib.metadata.files("kapitza") or []
    except importlib.metadata.PackageNotFoundError:
        files = []
    for file in files:
        if file.name == "kapitza" and file.parent.name == "bin" and (place := Path(str(file.locate()))).is_file():
            return place.resolve()
    if found := shutil.which("kapitza"):
        return Path(found)
    raise FileNotFoundError("the program kapitza is not installed: `pip install .` in its sources builds it; "
                            "or name it by the variable KAPITZA")


def command(words: Sequence[str | os.PathLike[str]], ranks: int = 1) -> list[str]:
    """The command line of the program with these words, under a launcher of MPI where there are several ranks."""
    if not isinstance(ranks, Integral) or ranks < 1:
        raise ValueError(f"ranks is {ranks!r}; it must be a whole number, at least 1")
    most = max(FEWEST_MOST_RANKS, RANKS_PER_CORE * (os.cpu_count() or 1))
    if ranks > most and not any(name.startswith(("SLURM_", "PBS_", "LSB_")) for name in os.environ):
        raise ValueError(f"ranks is {ranks}; on this machine it must be at most {most}, {RANKS_PER_CORE} for each core")
    own = program()
    started = [str(own), *map(_word, words)]
    return started if ranks == 1 else [_launcher(own), "-n", str(ranks), *started]


def _launcher(own: Path) -> str:
    """What starts several ranks of a program: KAPITZA_MPIRUN, else the mpiexec beside it, of the same MPI, else that of
    the PATH."""
    beside = own.parent / "mpiexec"
    chosen = os.environ.get("KAPITZA_MPIRUN")
    if beside.is_file():
        if chosen and Path(shutil.which(chosen) or chosen).resolve() != beside.resolve():
            warnings.warn(f"KAPITZA_MPIRUN names {chosen}; the launcher of this program's own MPI is {beside}",
                          stacklevel=4)
        return chosen or str(beside)
    if launcher := chosen or shutil.which("mpirun") or shutil.which("mpiexec"):
        return launcher
    raise FileNotFoundError(
        "mpirun is not on the PATH: install an MPI, name mpirun by the variable KAPITZA_MPIRUN, or take ranks=1")


def _word(word: str | os.PathLike[str]) -> str:
    """A word of a command line; a path that begins with - is no option."""
    text = passed_on(os.fspath(word), file_name=True)
    return f"./{text}" if text.startswith("-") and not isinstance(word, str) else text


def environment() -> dict[str, str]:
    """The variables that the program is started with: within a job of MPI without those that its launcher gave this
    process."""
    own = dict(os.environ)
    if IN_A_JOB & own.keys():
        own = {name: value for name, value in own.items() if not name.startswith(JOB_SETTINGS)}
    return MPI_SETTINGS | own


def ask(words: Sequence[str | os.PathLike[str]], scene: Scene, text: str | None = None) -> str:
    """What the program prints; SceneError or RunError where it ends otherwise. `text`: its standard input."""
    done = subprocess.run(command(words), input=text and passed_on(text), capture_output=True, text=True,
                          env=environment(), check=False)
    check_end(done.returncode, done.stderr, scene)
    return done.stdout


def check_end(status: int, errors: str, scene: Scene) -> None:
    """Raises what an exit status and the lines of standard error mean; warnings of the program become warnings of
    Python."""
    lines = errors.splitlines()
    for line in lines:
        if "warning: " in line:
            warnings.warn(line.split("warning: ", 1)[1], stacklevel=4)
    if status == 0:
        return
    said = [line.removeprefix(ERROR) for line in lines if line.startswith(ERROR)]
    text = said[-1] if said else "\n".join(lines[-5:]) or f"the program ended with status {status}"
    if status == REFUSED:
        raise scene_error(text.replace("use --force to overwrite it",
                                       "force=True overwrites it, resume=True goes on from it"), scene)
    raise RunError(text)


def source(scene: Scene) -> tuple[str | bytes, str, list[str]]:
    """Text, name in messages and changes of a scene, as the library takes them."""
    return (scene_bytes(scene.path) if scene.is_file else scene.text), str(scene.path), scene.sets[1::2]


def scene_bytes(path: Path) -> bytes:
    """The text as it stands in a file, which must be one and as large as scenes are."""
    try:
        with open(path, "rb") as file:
            text = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise SceneError(f"{path}: cannot be opened: {error.strerror}") from None
    return checked(text, str(path))


def checked(text: bytes, name: str) -> bytes:
    """The text, unless it is larger than a scene, or holds the character at which texts end."""
    if len(text) > MOST_BYTES:
        raise SceneError(f"{name}: has more than {MOST_BYTES} bytes; a scene has at most that many")
    if b"\0" in text:
        raise SceneError(f"{name}: holds the character NUL")
    return text


def scene_error(text: str, scene: Scene) -> SceneError:
    """The exception that a refusal becomes."""
    if not scene.is_file:
        text = re.sub(rf"(?:{re.escape(str(scene.path))}|(?<!\S)-):(\d+):(\d+): ", r"line \1, column \2: ", text)
        pattern = re.compile(_PLACE.pattern.replace(r".+?:\d+:\d+", r"line \d+, column \d+"))
    else:
        pattern = _PLACE
    if not (found := pattern.match(text)):
        return SceneError(text)
    return SceneError(text, found["key"], scene.value(found["key"]), found["place"])
