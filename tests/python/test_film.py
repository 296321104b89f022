"""film_basin.py: a film goes on with its own whole frames, and with nobody else's."""

import subprocess
import sys

import film_basin
import numpy as np
import pytest
from conftest import ROOT, plot, run_script
from PIL import Image, ImageSequence

SCENE = (ROOT / "scenes" / "small.yaml").read_text()
COUNTS = ("basin.theta.count", "basin.velocity.count")


@pytest.fixture
def film(tmp_path, monkeypatch):
    """film(first, last) makes a film of two frames of a coarse scene in the folder "film", without ffmpeg."""
    scene = tmp_path / "scene.yaml"
    scene.write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(film_basin.shutil, "which", lambda name: None)
    drawn = []

    def step(command):
        command = list(map(str, command))
        if "run" in command:
            command[command.index("--set"):command.index("--set")] = [word for key in COUNTS for word in ("--set", f"{key}=20")]
            run_command(command)
        else:
            drawn.append(command[-1])
            done = plot("basin", *command[2:])  # as the script does, in this process
            assert done.returncode == 0, done.stderr

    run_command = film_basin.step
    monkeypatch.setattr(film_basin, "step", step)

    def call(first, last, *options):
        drawn.clear()
        settings = ["--count", 2, "--ranks", 1, "--dpi", 30, *options]
        done = run_script(film_basin.main, scene, "pendulum.drive_amplitude", first, last, *settings)
        return done, len(drawn)

    return call


def test_a_film_goes_on_and_another_one_is_refused(film, tmp_path):
    done, drawn = film(0.15, 0.16)
    assert (done.returncode, drawn) == (0, 2), done.stderr
    frames = {path.name: path.read_bytes() for path in (tmp_path / "film").glob("frame-*")}
    assert set(frames) == {"frame-0000.png", "frame-0001.png"}
    (tmp_path / "film" / "frame-0001.png").unlink()
    (tmp_path / "film" / "part-frame-0001.png").write_bytes(b"cut short by a kill")
    done, drawn = film(0.15, 0.16)
    assert (done.returncode, drawn) == (0, 1), done.stderr
    assert (tmp_path / "film" / "frame-0001.png").read_bytes() == frames["frame-0001.png"]
    for change in ((0.15, 0.17), (0.15, 0.16, "--dpi", 40)):
        done, drawn = film(*change)
        assert (done.returncode, drawn) == (1, 0) and "holds frames of another film" in done.stderr
    (tmp_path / "scene.yaml").write_text(SCENE + "\n# edited\n")
    done, drawn = film(0.15, 0.16)
    assert (done.returncode, drawn) == (1, 0) and done.stderr.count("\n") == 1


def test_frames_without_a_record_are_another_film(film, tmp_path):
    (tmp_path / "film").mkdir()
    (tmp_path / "film" / "frame-0000.png").write_bytes(b"a holiday")
    done, drawn = film(0.15, 0.16)
    assert (done.returncode, drawn) == (1, 0) and "another film" in done.stderr
    assert (tmp_path / "film" / "frame-0000.png").read_bytes() == b"a holiday"


def test_a_film_that_falls_into_a_boundary(tmp_path):
    """Six frames to 1e-24 as GIF: none is empty, none is like the one before."""
    (tmp_path / "k01.yaml").write_text("pendulum: {k: 0.1, damping: 0.1, m: 0.4}\n"
                                       "basin: {theta: {count: 9}, velocity: {min: -20, max: 20, count: 9}, attractors: {starts: 512}}\n")
    subprocess.run([sys.executable, ROOT / "scripts" / "film_zoom.py", "k01.yaml", "-2.36717282205514094284618936441679793", "17",
                    "--to", "1e-24", "--count", "6", "--columns", "60", "--rows", "40", "-o", "zoom.gif"],
                   cwd=tmp_path, check=True, timeout=300)
    with Image.open(tmp_path / "zoom.gif") as film:
        pictures = [np.asarray(frame.convert("RGB").crop((0, 0, 60, 20))) for frame in ImageSequence.Iterator(film)]
    assert [len(np.unique(picture.reshape(-1, 3), axis=0)) > 1 for picture in pictures] == [True] * 6
    assert all((one != other).any() for one, other in zip(pictures, pictures[1:], strict=False))
