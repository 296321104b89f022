"""Films: one goes on with its own whole frames, and with nobody else's; pictures of one size, MP4 and GIF."""

import shutil
import struct
import subprocess
import sys
import zipfile
import zlib

import film_basin
import kapitza
import numpy as np
import pytest
from conftest import ROOT, run_script
from kapitza import films, recording
from kapitza.explorer import picture
from kapitza.result import BadFile
from PIL import Image, ImageSequence

SCENE = """
pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}
basin: {theta: {count: 20}, velocity: {min: -2, max: 2, count: 20}, attractors: {starts: 256}}
"""


@pytest.fixture
def film(tmp_path, monkeypatch):
    """film(first, last) makes a film of two frames of a coarse scene in the folder "film", without ffmpeg: a GIF."""
    scene = tmp_path / "scene.yaml"
    scene.write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(films.shutil, "which", lambda name: None)
    drawn = []

    def count(*arguments, **more):
        drawn.append(arguments)
        return kapitza.run(*arguments, **more)

    monkeypatch.setattr(film_basin, "run", count)

    def call(first, last, *options):
        drawn.clear()
        settings = ["--count", 2, "--ranks", 1, "--dpi", 30, *options]
        done = run_script(film_basin.main, scene, "pendulum.drive_amplitude", first, last, *settings)
        return done, len(drawn)

    return call


@pytest.mark.extensive
def test_a_film_goes_on_and_another_one_is_refused(film, tmp_path):
    done, drawn = film(0.15, 0.16)
    assert (done.returncode, drawn) == (0, 2), done.stderr
    frames = {path.name: path.read_bytes() for path in (tmp_path / "film").glob("frame-*")}
    assert set(frames) == {"frame-0000.png", "frame-0001.png"} and done.stdout.endswith("film.gif\n")
    with Image.open(tmp_path / "film" / "film.gif") as gif, Image.open(tmp_path / "film" / "frame-0000.png") as frame:
        assert (gif.n_frames, gif.size) == (2, frame.size)
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


@pytest.mark.extensive
def test_films_from_python_have_a_legend_that_stays(tmp_path):
    """The same kinds in the same order in every picture, with shares that are those of the labels."""
    assert kapitza.film(SCENE, "pendulum.drive_amplitude", [0.15, 0.3], tmp_path / "two.gif").name == "two.gif"
    legends = [films.kind_entries(kapitza.run(SCENE, set={"pendulum.drive_amplitude": value}, progress=False))
               for value in (0.15, 0.3)]
    assert [[entry[:2] for entry in entries] for entries in legends] == [[entry[:2] for entry in legends[0]]] * 2
    assert [sum(entry[2] for entry in entries) for entries in legends] == pytest.approx([1, 1])
    assert legends[0] != legends[1]


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")
def test_an_mp4_of_odd_pictures(tmp_path):
    pictures = [Image.new("RGB", (41, 31), colour) for colour in ("red", "blue", "green")]
    path = films.write_film(tmp_path / "odd.mp4", pictures, 5)
    assert path.read_bytes()[4:8] == b"ftyp"
    assert [entry.name for entry in tmp_path.iterdir()] == ["odd.mp4"]
    with pytest.raises(kapitza.BadFile, match="no pictures to make a film of"):
        films.write_film(tmp_path / "none.gif", [], 5)


@pytest.mark.extensive
def test_a_film_that_falls_into_a_boundary(tmp_path):
    """Six frames to 1e-24 as GIF: none is empty, none is like the one before."""
    (tmp_path / "k01.yaml").write_text("pendulum: {k: 0.1, damping: 0.1, m: 0.4}\n"
                                       "basin: {theta: {count: 9}, velocity: {min: -20, max: 20, count: 9}, "
                                       "attractors: {starts: 512}}\n")
    subprocess.run([sys.executable, ROOT / "scripts" / "film_zoom.py", "k01.yaml",
                    "-2.36717282205514094284618936441679793", "17",
                    "--to", "1e-24", "--count", "6", "--columns", "60", "--rows", "40", "-o", "zoom.gif"],
                   cwd=tmp_path, check=True)
    with Image.open(tmp_path / "zoom.gif") as film:
        pictures = [np.asarray(frame.convert("RGB").crop((0, 0, 60, 20))) for frame in ImageSequence.Iterator(film)]
    assert [len(np.unique(picture.reshape(-1, 3), axis=0)) > 1 for picture in pictures] == [True] * 6
    assert all((one != other).any() for one, other in zip(pictures, pictures[1:], strict=False))


@pytest.mark.parametrize("name, first", [("film.gif", b"GIF8"), ("film.mp4", b"ftyp")])
def test_a_recording_of_the_explorer_becomes_a_film(tmp_path, name, first):
    if name.endswith("mp4") and not shutil.which("ffmpeg"):
        pytest.skip("no ffmpeg")
    with zipfile.ZipFile(tmp_path / "film.zip", "w") as archive:
        for number, size in enumerate([(31, 20), (31, 20), (40, 26)]):
            with archive.open(f"film-{number:03}.png", "w") as file:
                Image.new("RGB", size, (40 * number, 90, 10)).save(file, format="PNG")
    recording.main([str(tmp_path / "film.zip"), "-o", str(tmp_path / name)])
    assert first in (tmp_path / name).read_bytes()[:16]
    if name.endswith("gif"):
        with Image.open(tmp_path / name) as film:
            assert (film.n_frames, film.size) == (3, (31, 20))


def test_what_is_no_recording_is_refused(tmp_path):
    (tmp_path / "a.zip").write_bytes(b"no archive")
    with zipfile.ZipFile(tmp_path / "b.zip", "w") as archive:
        archive.writestr("film-000.png", "no picture")
    for name in ("a.zip", "b.zip"):
        with pytest.raises(BadFile, match="is not a ZIP of pictures"):
            recording.main([str(tmp_path / name), "-o", str(tmp_path / "film.gif")])
    with pytest.raises(SystemExit):
        recording.main([str(tmp_path / "a.zip"), "-o", str(tmp_path / "film.avi")])


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height):
    """A PNG of a few bytes whose header says how large it is."""
    header = struct.pack(">2I5B", width, height, 1, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0")) + chunk(b"IEND", b"")


@pytest.mark.parametrize("content, wrong", [
    (png(30000, 30000), "has 30000 x 30000 pixels"), (png(12000, 12000), "has 12000 x 12000 pixels"),
    (b"BM" + bytes(60), "is no PNG"), (png(30, 30)[:20], "is no PNG"), (png(30, 30), "truncated")])
def test_pictures_that_are_too_large_or_damaged_cost_one_line(tmp_path, content, wrong):
    """Nothing is made of them: neither pixels in memory nor a part of a film."""
    with zipfile.ZipFile(tmp_path / "film.zip", "w") as archive:
        archive.writestr("film-000.png", content)
    for name in ("film.gif", "film.mp4"):
        with pytest.raises((BadFile, OSError), match=wrong):
            recording.main([str(tmp_path / "film.zip"), "-o", str(tmp_path / name)])
    assert [path.name for path in tmp_path.iterdir()] == ["film.zip"]


def test_a_damaged_archive_costs_one_line(tmp_path):
    """Bytes that do not unpack, and a picture that would unpack to gigabytes."""
    path = tmp_path / "film.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("film-000.png", png(30, 30) + bytes(1000))
        packed = archive.getinfo("film-000.png")
    whole = path.read_bytes()
    start = packed.header_offset + 30 + len(packed.filename)
    path.write_bytes(whole[:start] + b"\xff" * 10 + whole[start + 10:])
    with pytest.raises(BadFile, match="is not a ZIP of pictures"):
        recording.main([str(path), "-o", str(tmp_path / "film.gif")])
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED,
                         compresslevel=1) as archive, archive.open("film-000.png", "w") as file:
        for _ in range(140):
            file.write(bytes(1_000_000))
    with pytest.raises(BadFile, match="takes more than 133 MB"):
        recording.main([str(path), "-o", str(tmp_path / "film.gif")])


def test_a_saved_picture_of_impossible_size_is_damaged(tmp_path):
    (tmp_path / "a.png").write_bytes(png(30000, 30000))
    with pytest.raises(BadFile, match="a.png: damaged"):
        picture.scene_in(tmp_path / "a.png")


def test_a_rate_that_no_film_has_is_refused_before_anything_runs():
    for rate in (0, 2000):
        with pytest.raises(ValueError, match=f"rate {rate} is out of range"):
            kapitza.film("no such scene", "pendulum.k", [1], rate=rate)
