"""What a page is answered: frames are those of a run, orbits and ends of starts those of the commands; what is wrong is
one line."""

import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import PROGRAM, ROOT, settings
from serving import Server, places

FIG12 = ROOT / "scenes" / "blackburn-fig12.yaml"
WINDOW = {"theta": {"min": 0.2, "max": 2.7}, "velocity": {"min": -1, "max": 0.5}}
AXES = "{min: 0.2, max: 2.7, count: 44}", "{min: -1, max: 0.5, count: 30}"
CELLS = {"request": "frame", "rows": 10, "columns": 10}
OTHER = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.31}


@pytest.fixture(scope="module")
def server():
    return Server(FIG12)


def strobe(attractors, labels):
    """The first strobe point of each cell's attractor: what labels mean, whatever their numbers."""
    table = np.array([*(attractor["strobe"][0] for attractor in attractors), [np.nan, np.nan]])
    return table[np.where(labels == 255, len(attractors), labels)]


def ends(server, header, planes):
    return strobe(server.catalogues[header["catalogue"]], planes["labels"])


def test_a_frame_at_rest_is_what_a_run_of_method_exact_writes(server, tmp_path):
    sets = [f"basin.theta={AXES[0]}", f"basin.velocity={AXES[1]}", "basin.method=exact"]
    options = settings(*sets)
    subprocess.run([PROGRAM, "run", FIG12, "-o", tmp_path / "out.h5", *options], check=True, capture_output=True)
    _, frames = server.frame(30, 44, ("labels", "settling_time", "doubt", "other"), window=WINDOW, levels=[8, 1])
    planes = frames[-1][1]
    attractors = server.ask("catalogue")[0][0]["attractors"]
    with h5py.File(tmp_path / "out.h5") as file:
        ids = file["basin/attractor"][:]
        points = np.stack([file["attractors/strobe_theta"][:, 0], file["attractors/strobe_velocity"][:, 0]], axis=1)
    assert np.allclose(strobe(attractors, planes["labels"]), points[ids], rtol=0, atol=1e-11)
    assert np.all(planes["doubt"] == 0) and np.all(planes["other"]
                                                   == 255) and np.all(np.isfinite(planes["settling_time"]))


def test_smooth_times_have_no_steps(server):
    """Whole periods are steps of 1; the second difference of a smooth time is small, and it is the same in a moving
    frame."""
    window = {"theta": {"min": 0.3, "max": 0.4}, "velocity": {"min": 0.02, "max": 0.08}}
    times = [server.frame(40, 60, ("labels", "smooth_time"), window=window, quality=quality)[1][-1][1]["smooth_time"]
             for quality in ("exact", "moving")]
    assert np.ptp(times[0]) > 5 and all(np.max(np.abs(np.diff(times[0], 2, axis=axis))) < 0.1 for axis in (0, 1))
    assert np.allclose(times[0], times[1], rtol=0, atol=0.01)


def test_a_moving_frame_is_rougher_by_one_cell_in_a_hundred_at_most(server):
    server.frame(100, 160, quality="moving")  # attractors that it lacks are looked for behind it
    exact, moving = (ends(server, *server.frame(100, 160, quality=quality)[1][-1]) for quality in ("exact", "moving"))
    assert 0 < np.mean(np.any(abs(exact - moving) > 1e-6, axis=-1)) < 0.015


def test_samples_of_a_deep_window_stand_for_its_cells(server):
    """They lie within a thirty-second of a cell; where basins are fractal, that changes some labels. A level shows
    cells of the frame."""
    window = {"theta": {"centre": "-0.2640114250694581920926546831048437", "width": 1e-20},
              "velocity": {"centre": "1.42", "width": 1e-20}}
    exact, moving = (server.frame(40, 60, window=window, levels=[4, 1], quality=quality)[1]
                     for quality in ("exact", "moving"))
    ends_of = [ends(server, *frames[-1]) for frames in (exact, moving)]
    assert 0 < np.mean(np.any(abs(ends_of[0] - ends_of[1]) > 1e-6, axis=-1)) < 0.1
    assert np.array_equal(moving[0][1]["labels"], moving[1][1]["labels"][np.ix_(places(4, 40), places(4, 60))])


def test_frames_have_turns(server):
    """As `where` has them; mirrored cells the other way round; none of quick frames."""
    _, [(_, exact)] = server.frame(20, 30, ("turns", "labels"), quality="exact")
    _, [(_, moving)] = server.frame(20, 30, ("labels", "turns"), quality="moving")
    turns = exact["turns"]
    assert np.array_equal(turns, -turns[::-1, ::-1],
                          equal_nan=True) and np.nanmax(turns) > 1 and np.all(np.isnan(moving["turns"]))
    for row, column in ((3, 4), (10, 15), (12, 3)):
        theta, velocity = -np.pi + (2 * column + 1) * np.pi / 30, -2 + (2 * row + 1) * 2 / 20
        header, _ = server.ask("where", theta=theta, velocity=velocity)[0]
        assert header["turns"] == (None if np.isnan(turns[row, column]) else turns[row, column])


def ticks_of_threads():
    """Ticks that threads of this process have taken beside its first one, those that have ended too."""
    def taken(path):
        return sum(int(ticks) for ticks in Path(path).read_text().rsplit(")", 1)[1].split()[11:13])

    return taken("/proc/self/stat") - taken(f"/proc/self/task/{os.getpid()}/stat")


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="one core")
@pytest.mark.parametrize("quality, size", [("moving", (360, 480)), ("exact", (110, 150))])
def test_cores_share_a_frame(quality, size):
    """The same bytes on one core and on two."""
    cores, server, planes, ticks = sorted(os.sched_getaffinity(0)), Server(FIG12), [], []
    try:
        for allowed in (cores[:1], cores[:1], cores[:2]):
            os.sched_setaffinity(0, allowed)
            before = ticks_of_threads()
            planes.append(server.frame(*size, ("labels", "settling_time", "smooth_time"), window=WINDOW,
                                       quality=quality)[1][-1][1])
            ticks.append(ticks_of_threads() - before)
    finally:
        os.sched_setaffinity(0, cores)
    assert all(plane.tobytes() == planes[2][name].tobytes() for name, plane in planes[1].items())
    assert ticks[2] > max(ticks[1], 0)


@pytest.mark.parametrize(("keys", "words"), [
    ({"request": "fame"}, "'fame' is unknown; it must be frame, where"),
    ({"request": "frame", "columns": 10}, "rows: is missing"),
    ({"request": "where", "theta": 1}, "velocity: is missing"),
    ({"request": "where", "theta": "x", "velocity": 1}, 'THETA: "x" is not'),
    ({"request": "where", "theta": 1, "velocity": [[]]}, "velocity: must be a number"),
    ({"request": "where", "theta": 1, "velocity": float("nan")}, "is not a finite decimal number"),
    ({"request": "where", "theta": int("1" + "0" * 40), "velocity": 0}, "is out of range"),
    ({"request": "where", "theta": "\ud83d", "velocity": 0}, "half of a character"),
    ({"request": "where", "theta": "1\0", "velocity": 0}, "NUL"),
    ({"request": "orbit", "theta": 1, "velocity": 0, "periods": 100000, "samples_per_period": 4096},
     "more than 16777216 samples"),
    ({"request": "orbit", "theta": 1}, "velocity: is missing"),
    ({"request": "orbit", "theta": "x", "velocity": 0}, "theta: 'x' is not"),
    ({"request": "chart", "x": {}}, "needs the mappings x and y"),
    ({"request": "chart", "x": {}, "y": {}}, "sweep.measure"),
    ({**CELLS, "rows": 8192, "columns": 8192}, "more than 16777216 cells"),
    ({**CELLS, "levels": [1, 8]}, "falling order"),
    ({**CELLS, "planes": ["colour"]}, "planes: must be a list from labels"),
    ({**CELLS, "quality": "fine"}, "quality: 'fine' is unknown"),
    ({**CELLS, "pendulum": {"k": 0.1, "m": 0.3}}, "pendulum.damping: is missing"),
    ({**CELLS, "pendulum": [1]}, "pendulum: must be a mapping"),
    ({**CELLS, "window": {"velocity": {"min": 2, "max": 1}}}, "basin.velocity.max"),
    ({**CELLS, "pendulum": {"a}": {}}}, "change: "),
    ({**CELLS, "atlas": "none.h5", "x": 1, "y": 2}, "none.h5: cannot be opened"),
    ({**CELLS, "atlas": "/dev/zero", "x": 1, "y": 2}, "is not a regular file"),
    ({**CELLS, "x": 1}, "x: is a point of an atlas")])
def test_what_is_wrong_is_one_line(server, keys, words):
    (header, _), = server.ask(**keys)
    assert header["answer"] == "error" and header["status"] == 2 and words in header["message"]
    assert "\n" not in header["message"] and not header["message"].startswith("-:")
    assert server.ask("where", theta=3.1, velocity=0)[0][0]["answer"] == "where"


def test_a_frame_for_which_memory_is_short_is_one_error():
    """4096 x 4096 cells do not fit: that is told before the frame begins, and the next one is made."""
    code = f"""
import resource, sys
sys.path.insert(0, {str(ROOT / "tests" / "python")!r})
from serving import Server
running = Server({str(FIG12)!r})
pages = int(open("/proc/self/statm").read().split()[0])
resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + 400_000_000,) * 2)
planes = ["labels", "settling_time", "smooth_time", "doubt"]
for quality in "exact", "moving":
    (header, _), = running.ask("frame", rows=4096, columns=4096, planes=planes, quality=quality)
    assert (header["answer"], header["status"]) == ("error", 1) and "rows: needs" in header["message"], header
assert len(running.frame(30, 44)[1]) > 0
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_attractors_keep_their_tracks_when_a_slider_moves(server):
    before = server.ask("catalogue")[0][0]["attractors"]
    catalogue, _ = server.frame(20, 30, pendulum=OTHER, quality="moving")
    assert catalogue["pendulum"]["m"] == 0.31
    tracks = {attractor["track"]: attractor["name"] for attractor in before}
    shared = [attractor for attractor in catalogue["attractors"] if attractor["track"] in tracks]
    assert len(shared) >= 4 and all(tracks[attractor["track"]] == attractor["name"] for attractor in shared)


def test_an_attractor_that_is_born_under_a_slider_is_found_at_the_next_frame(server):
    """From 0.3 to 0.33 at once, requests without a pause: a cycle of four periods is new there, and none of its cells
    stays open."""
    server.frame(50, 80, quality="moving")
    frames = [server.frame(50, 80, pendulum={**OTHER, "drive_amplitude": 0.33}, quality="moving")[1] for _ in range(2)]
    first, second = (np.mean(planes["labels"] == 255) for (_, planes), in frames)
    assert first > 0.04 and second < 0.002


def test_few_open_cells_are_no_reason_for_a_search_between_frames(server):
    """Along the map of Fig. 12 a cascade of rotations ends in cycles of 24 periods, of some cells, which are lost at
    the next value."""
    longest = 0
    for share in (0, 1, 2, 2):
        pendulum = {**OTHER, "drive_frequency": 11 + 0.02 * share, "drive_amplitude": 0.3 + 0.0004 * share}
        catalogue, frames = server.frame(250, 400, pendulum=pendulum, quality="moving")
        longest = max(attractor["period"] for attractor in catalogue["attractors"]) if catalogue else longest
    assert 0 < np.mean(frames[-1][1]["labels"] == 255) < 0.01 and longest < 12


def test_a_chaotic_attractor_is_carried_along_a_slider(server):
    """A tilted drive, half of whose starts end in chaos: none of them stays open at the next values."""
    for tilt in (0.1, 0.101, 0.102):
        catalogue, frames = server.frame(40, 60, pendulum={"k": 0.1, "damping": 0.1, "m": 0.4, "tilt": tilt},
                                         quality="moving")
        labels = frames[-1][1]["labels"]
        chaotic = [attractor["id"] for attractor in catalogue["attractors"] if attractor["kind"] == "chaotic"]
        assert len(chaotic) == 1 and 0.4 < np.mean(labels == chaotic[0]) < 0.55 and np.mean(labels == 255) < 0.01


def test_a_running_state_is_born_along_a_slider(server):
    """At the torque .127; the frame that follows shows it."""
    for torque, kinds in ((0.125, {"down"}), (0.13, {"down"}), (0.14, {"down", "running +"})):
        catalogue, frames = server.frame(40, 60, pendulum={"k": 1, "damping": 0.1, "m": 0, "torque": torque},
                                         quality="moving")
        assert {attractor["kind"] for attractor in catalogue["attractors"]} == kinds
        assert np.any(frames[-1][1]["labels"] == 255) == (torque == 0.13)


def test_a_running_state_is_carried_along_a_slider(server):
    """Its band is found anew at each value, with numerics for its speed; it keeps its colour, and every start has its
    end."""
    tracks = set()
    for torque in (0.5, 0.501, 0.502, 0.55):
        catalogue, frames = server.frame(40, 60, pendulum={"k": 1, "damping": 0.1, "m": 0, "torque": torque},
                                         quality="moving")
        found = {attractor["kind"]: attractor for attractor in catalogue["attractors"]}
        labels = frames[-1][1]["labels"]
        assert set(found) == {"down", "running +"} and not np.any(labels == 255)
        assert found["running +"]["mean_velocity"] == pytest.approx(10 * torque, abs=0.02)
        tracks.add(found["running +"]["track"])
    assert len(tracks) == 1
    exact = server.frame(40, 60, pendulum={"k": 1, "damping": 0.1, "m": 0, "torque": torque},
                         quality="exact")[1][-1][1]["labels"]
    assert np.mean(exact != labels) < 0.01


def test_weaker_damping_gets_more_periods_than_the_scene_has(server):
    """And not as many as its motions take to settle, 900 on average: orbits have told regions that trap earlier."""
    _, frames = server.frame(20, 30, ("labels", "settling_time"), pendulum={**OTHER, "quality_factor": 60},
                             quality="moving")
    planes = frames[-1][1]
    assert np.mean(planes["labels"] == 255) < 0.2
    assert 60 < np.nanmean(planes["settling_time"]) < 450


def test_a_moving_frame_of_weak_damping_shows_the_same_basins(server):
    """Lace finer than a cell is another lace; what fills cells is the same, rotations to either side included."""
    weak = {**OTHER, "quality_factor": 20}
    exact, moving = (ends(server, *server.frame(24, 36, pendulum=weak, quality=quality)[1][-1])
                     for quality in ("exact", "moving"))
    assert np.mean(np.any(abs(exact - moving) > 1e-4, axis=-1)) < 0.2


def test_where_answers_as_the_command_does(server):
    answer = server.ask("where", theta="1.2", velocity=0.3)[0][0]
    told = json.loads(subprocess.run([PROGRAM, "where", FIG12, "1.2", "0.3", "--json"], check=True,
                                     capture_output=True).stdout)
    same = [key for key in told if key not in ("attractor", "error", "settling_time")]
    assert {key: answer[key] for key in same} == {key: told[key] for key in same}


def test_an_orbit_is_that_of_the_pendulum(server):
    header, payload = server.ask("orbit", theta="1.2", velocity=0.3, periods=3, samples_per_period=32)[0]
    theta, velocity = np.frombuffer(payload, "<f8").reshape(2, header["samples"])
    assert header["samples"] == 97 and (theta[0], velocity[0]) == (1.2, 0.3)
    t = 2 * np.pi / 32 * np.arange(97)
    acceleration = -header["damping"] * velocity - (header["k"] - header["m"] * np.cos(t)) * np.sin(theta)
    assert np.allclose(np.gradient(velocity, t, edge_order=2), acceleration, atol=2e-2)
    assert np.allclose(np.gradient(theta, t, edge_order=2), velocity, atol=2e-2)


def test_a_chart_tells_periods(server):
    x, y = ({"parameter": name, "min": low, "max": high, "count": 12} for name, low, high in
            (("drive_amplitude", 0.1, 0.5), ("drive_frequency", 8, 12)))
    answers = server.ask("chart", x=x, y=y, levels=[4, 1])
    header, payload = answers[-1]
    period, centre = np.frombuffer(payload, np.uint8).reshape(2, 12, 12)
    assert len(answers) == 2 and set(np.unique(period)) <= {0, *range(1, 17), 255} and np.all(centre[period == 1] <= 3)
    assert np.any((period == 1) & (centre == 1)) and np.any((period == 1) & (centre == 0))


def resident_bytes():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def drag(server, views):
    """Sliders and windows that move, rests between."""
    for i in range(views):
        pendulum = {**OTHER, "drive_amplitude": 0.30 + 0.01 * (i % 50) / 50}
        centre, width = 1 + 0.3 * np.sin(i), 2 * 0.97 ** (i % 100)
        window = {"theta": {"centre": f"{centre:.20f}", "width": f"{width:.20f}"},
                  "velocity": {"min": -width, "max": width}}
        server.frame(50, 80, pendulum=pendulum, window=window, levels=[8, 1], quality="exact" if i % 25 == 0
                     else "moving")


@pytest.mark.extensive
def test_a_thousand_views_leave_nothing_behind():
    server = Server(FIG12)
    drag(server, 200)
    before = resident_bytes()
    drag(server, 1000)
    assert resident_bytes() < before + 16e6
