"""kapitza.Pendulum: what it returns, the same labels as runs, Ctrl-C, threads, forks, memory that runs out."""

import inspect
import json
import os
import pickle
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import kapitza
import numpy as np
import pytest
from conftest import PROGRAM, ROOT
from matplotlib import pyplot

FIG12 = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
SLOW = "p = kapitza.Pendulum(quality_factor=20, drive_frequency=11, drive_amplitude=0.3)"


@pytest.fixture(scope="module")
def pendulum():
    return kapitza.Pendulum(**FIG12)


def test_labels_are_those_of_a_run():
    """Bit for bit, for every cell of Fig. 12 at a low resolution."""
    set = {f"basin.{axis}.count": count for axis, count in (("theta", 60), ("velocity", 80))}
    result = kapitza.run(ROOT / "scenes" / "blackburn-fig12.yaml", set=set | {"basin.method": "exact"}, progress=False)
    basin = result.group("basin")
    own = kapitza.Pendulum(ROOT / "scenes" / "blackburn-fig12.yaml")
    names = result.attractors["name"]
    theta, velocity = np.meshgrid(basin.theta.values, basin.velocity.values)
    ends = own.where(theta, velocity)
    frame = own.basin(theta=60, velocity=80)
    assert np.array_equal(frame.theta, basin.theta) and np.array_equal(frame.velocity, basin.velocity)
    wanted = names.reindex(basin.attractor.values.ravel()).tolist()
    for found in (ends, frame):
        assert found.name.to_series().reindex(found.attractor.values.ravel()).tolist() == wanted
    assert list(ends.name.values) == names.tolist() and np.array_equal(ends.attractor, basin.attractor)
    assert np.array_equal(frame.attractor, basin.attractor) and np.array_equal(frame.evidence == 3, basin.evidence == 3)
    assert not {1, 2} - set_of(ends.evidence) and set_of(ends.evidence) == set_of(frame.evidence)


def set_of(values):
    return {int(value) for value in np.unique(values)}


def test_attractors_are_those_of_a_run(pendulum):
    scene = {"pendulum": FIG12, "attractors": {"velocity": {"min": -2, "max": 2}}}
    wanted, found = kapitza.run(scene, progress=False).attractors, pendulum.attractors()
    assert list(found.columns) == [name for name in wanted.columns if name != "fraction"]
    assert found["name"].tolist() == wanted["name"].tolist()
    assert np.allclose(np.concatenate(found["strobe_theta"].tolist()), np.concatenate(wanted["strobe_theta"].tolist()),
                       atol=1e-11)


def test_the_map_goes_back_and_its_tangent_is_that_of_differences(pendulum):
    theta, velocity = np.meshgrid(np.linspace(-3, 3, 7), np.linspace(-1, 1, 5))
    there = pendulum.map(theta, velocity, 3, tangent=True)
    back = pendulum.map(there.theta, there.velocity, -3, tangent=True)
    assert there.theta.shape == (5, 7) and there.tangent.shape == (5, 7, 2, 2)
    assert np.allclose(back.theta, theta, atol=1e-9) and np.allclose(back.velocity, velocity, atol=1e-9)
    assert np.allclose(back.tangent @ there.tangent, np.eye(2), atol=1e-7) and np.array_equal(back.turns, -there.turns)
    step = 1e-6
    for column, (more, faster) in enumerate(((step, 0), (0, step))):
        ahead, behind = (pendulum.map(theta + sign * more, velocity + sign * faster, 3) for sign in (1, -1))
        apart = np.remainder(ahead.theta - behind.theta + np.pi, 2 * np.pi) - np.pi
        wanted = np.stack([apart, ahead.velocity - behind.velocity], axis=-1) / (2 * step)
        assert np.allclose(there.tangent[..., column], wanted, rtol=1e-5, atol=1e-5)
    assert np.allclose(np.linalg.det(there.tangent), np.exp(-3 * 2 * np.pi * pendulum.parameters["beta"]))


def test_every_drive_goes_back():
    tilted = kapitza.Pendulum(k=0.1, damping=0.05, m=0.4, tilt="10 deg", ellipse=0.3, torque=0.02,
                              harmonics=[{"order": 2, "amplitude": 0.3, "phase": 1.0}])
    there = tilted.map(np.linspace(-3, 3, 9), 0.1, 5)
    assert np.allclose(tilted.map(there.theta, there.velocity, -5).theta, np.linspace(-3, 3, 9), atol=1e-9)
    assert not tilted.cycle(0.1, 0).symmetric


def test_units_are_those_of_a_scene():
    keys = {"length": "20 cm", "frequency": "50 Hz", "amplitude": "1 cm", "quality_factor": 20}
    assert kapitza.Pendulum(**keys).parameters["pivot_frequency"] == pytest.approx(100 * np.pi)
    ends = kapitza.Pendulum(**keys).where("170 deg", ["3 rad/s", "90 deg/s"])
    assert np.allclose(ends.theta, np.radians(170)) and np.allclose(ends.velocity, [3 / (100 * np.pi), 0.5 / 100])


def test_cycles_are_those_of_a_run(pendulum):
    scene = {"pendulum": FIG12, "saddles": {"velocity": {"min": -2, "max": 2}, "max_period": 2}}
    wanted, found = kapitza.run(scene, progress=False).group("saddles"), pendulum.saddles(2)
    assert found.name.values.tolist() == wanted.name.values.tolist() and found.attrs["open_sums"] == 0
    assert np.array_equal(found.strobe_theta, wanted.strobe_theta, equal_nan=True)
    assert np.array_equal(found.multiplier_re, wanted.multiplier_re)


def test_a_cycle_near_a_state(pendulum):
    found = pendulum.cycle("179 deg", 0)
    assert found.name == "inverted" and found.symmetric == 1 and abs(abs(float(found.strobe_theta[0])) - np.pi) < 1e-12
    theta, velocity = found.strobe_theta.values, found.strobe_velocity.values
    matrix = pendulum.map(theta, velocity, tangent=True).tangent[0]
    multipliers = found.multiplier_re.values + 1j * found.multiplier_im.values
    assert np.allclose(sorted(np.linalg.eigvals(matrix), key=lambda value: value.imag),
                       sorted(multipliers, key=lambda value: value.imag))
    with pytest.raises(ValueError, match="no cycle that closes after 1 periods lies within 1e-06 rad"):
        pendulum.cycle(1.0, 0.5, within=1e-6)


def test_a_manifold_leads_to_its_saddle(pendulum):
    saddle = pendulum.saddles().isel(cycle=0)
    for stable, periods in ((True, 8), (False, -8)):
        line = pendulum.manifold(saddle, stable=stable, length=1)
        assert line["arc_length"].iloc[-1] >= 1 and line["arc_length"].is_monotonic_increasing
        near = line[line["arc_length"] < 0.05]
        image = pendulum.map(near["theta"], near["velocity"], periods)
        assert np.hypot(image.theta - float(saddle.strobe_theta[0]),
                        image.velocity - float(saddle.strobe_velocity[0])).max() < 0.02


def test_an_orbit_passes_the_strobes_of_the_map(pendulum):
    motion = pendulum.orbit(3.0, 0.1, periods=6, samples_per_period=8)
    assert len(motion) == 49 and motion["time"].iloc[-1] == pytest.approx(12 * np.pi)
    states = pendulum.map(np.full(6, 3.0), 0.1, 6)
    assert np.remainder(motion["theta"].iloc[-1], 2 * np.pi) == pytest.approx(np.remainder(states.theta[0], 2 * np.pi),
                                                                              abs=1e-10)


def test_a_basin_is_drawn_into_axes_of_others(pendulum):
    basin = pendulum.basin(theta=20, velocity=(-2, 2, 30))
    figure, axes = pyplot.subplots()
    assert basin.kapitza.plot(axes, colours={"inverted": "#102030"}, dots=False) is axes
    image = axes.images[0].get_array()
    inverted = basin.kapitza.attractors.index[basin.kapitza.attractors["name"] == "inverted"][0]
    assert np.allclose(image[basin.attractor.values == inverted], np.array([0x10, 0x20, 0x30]) / 255)
    assert basin.kapitza.fractions().sum() == pytest.approx(1) and basin.attractor.dims == ("velocity", "theta")
    pyplot.close(figure)


def test_a_window_of_any_depth(pendulum):
    words = ["where", ROOT / "scenes" / "blackburn-fig12.yaml", "3.1", "0.2", "2.9", "0.2", "--boundary", "30",
             "--json"]
    point = json.loads(subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=True).stdout)
    axes = [{"centre": point[name], "width": 1e-25, "count": 8} for name in ("theta", "velocity")]
    assert len(set_of(pendulum.basin(*axes).attractor)) > 1


def test_a_wrong_key_is_told(pendulum):
    with pytest.raises(kapitza.SceneError, match="did you mean drive_frequency") as caught:
        kapitza.Pendulum(quality_factor=5, drive_frequenzy=11)
    assert caught.value.key == "pendulum.drive_frequenzy"
    with pytest.raises(kapitza.SceneError, match="must be numbers of at most"):
        pendulum.where(np.nan, 0)
    with pytest.raises(kapitza.SceneError, match="basin.theta.count"):
        pendulum.basin(theta=0)


def test_with_makes_another_pendulum_and_keeps_the_first(pendulum):
    other = pendulum.with_(epsilon=0.31)
    assert other.parameters["m"] == 0.31 and pendulum.parameters["m"] == 0.3
    assert repr(pickle.loads(pickle.dumps(other)).parameters) == repr(other.parameters)
    assert len(kapitza.Pendulum(k=0.1, damping=0, m=0.1).attractors()) == 0
    assert kapitza.Pendulum(k=0.1, damping=0, m=0.1).where(1.0, 0.0).attractor == -1


def test_every_help_begins_with_an_example_that_runs():
    """And names of the package are public ones."""
    from kapitza.pendulum import Pendulum
    methods = [value for name, value in vars(Pendulum).items() if not name.startswith("_")]
    for thing in [Pendulum, *methods]:
        text = inspect.getdoc(thing)
        lines = [line[4:] for line in text.splitlines() if line.startswith(">>> ")]
        assert lines, thing
        assert thing is Pendulum or text.split("\n\n")[1].startswith(">>> "), thing
        exec("\n".join(lines), {"kapitza": kapitza, "np": np})
        pyplot.close("all")
    assert all(not name.startswith("_") or name == "__version__" for name in dir(kapitza))
    assert len(inspect.getdoc(kapitza).splitlines()) < 40


def run(code, timeout=120, **environment):
    line = [sys.executable, "-c", f"import kapitza, numpy as np, os, signal, sys, threading, time\n{code}"]
    paths = {"PYTHONPATH": str(ROOT / "python")} | environment
    return subprocess.run(line, capture_output=True, text=True, timeout=timeout, env=os.environ | paths)


@pytest.mark.parametrize("call",
                         ["p.where(np.linspace(-3, 3, 10**6), 0.3)", "p.basin(theta=3000, velocity=(-2, 2, 3000))",
                                  "p.map(np.zeros(1000), 0.5, 10**7)", "p.cycles(max_period=9)",
                                  "p.orbit(1, 0, periods=10**6)"])
def test_a_signal_ends_a_call(call):
    """The handler runs within the call, and its exception ends it; the next call is right."""
    code = f"""
{SLOW}
before = p.map(1.0, 0.5, 7).theta
class Late(Exception): pass
def ring(*_): raise Late
signal.signal(signal.SIGALRM, ring)
signal.setitimer(signal.ITIMER_REAL, 1.0)
try:
    {call}
    print("too short")
except Late:
    print("ended")
assert p.map(1.0, 0.5, 7).theta == before and p.where(3.1, 0.0).attractor >= 0
"""
    done = run(code)
    assert done.stdout.strip() == "ended", done


def test_ctrl_c_ends_a_call():
    done = run(f"""
{SLOW}
signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell starts in the background ignores it
threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    p.where(np.linspace(-3, 3, 10**6), 0.3)
except KeyboardInterrupt:
    print("interrupted")
""")
    assert done.stdout.strip() == "interrupted", done


def test_a_long_search_looks_for_a_stop_all_the_time():
    """Ellipses of attractors under weak damping took a second of the processor without a look."""
    own, seen = kapitza.Pendulum(quality_factor=20000, drive_frequency=11, drive_amplitude=0.3), []
    library = own._library

    def look(context):
        seen.append(time.thread_time())
        return seen[-1] - seen[0] > 4

    pause = library.ffi.callback("kapitza_pause", look)

    def work():
        library.lib.kapitza_set_pause(pause, library.ffi.NULL)
        look(None)
        with pytest.raises(KeyboardInterrupt):
            own.attractors()

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert np.diff(seen).max() < 0.1 * (seen[-1] - seen[0])


def test_threads_find_what_one_thread_finds(pendulum):
    """On one pendulum and on several: what one thread alone finds."""
    theta, velocity = np.linspace(-3, 3, 400), 0.4
    wanted = pendulum.where(theta, velocity).attractor.values
    others = [pendulum, pendulum, *(kapitza.Pendulum(**FIG12) for _ in range(2))]
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(lambda own: own.where(theta, velocity).attractor.values, others))
        basins = list(threads.map(lambda own: own.basin(40, (-2, 2, 40)).attractor.values, others))
    assert all(np.array_equal(labels, wanted) for labels in found)
    assert all(np.array_equal(labels, basins[0]) for labels in basins)


def test_a_thread_leaves_the_others_running():
    """A call does not hold the interpreter."""
    done = run("""
p = kapitza.Pendulum(quality_factor=5, drive_frequency=11, drive_amplitude=0.3)
counted, stop = 0, False
def work():
    global stop
    p.where(np.linspace(-3, 3, 200000), 0.3)
    stop = True
thread = threading.Thread(target=work)
thread.start()
while not stop: counted += 1
print(counted > 10000)
""")
    assert done.stdout.strip() == "True", done


def test_a_forked_process_uses_the_pendulum_between_calls_alone():
    """A process that was forked between calls uses the pendulum; one that was forked during a call is refused."""
    done = run("""
import warnings; warnings.simplefilter("ignore")
p = kapitza.Pendulum(quality_factor=5, drive_frequency=11, drive_amplitude=0.3)
first = int(p.where(3.1, 0.0).attractor)
if (child := os.fork()) == 0: os._exit(0 if int(p.where(3.1, 0.0).attractor) == first else 1)
print(os.waitpid(child, 0)[1])
children = []
def look(context):
    if children: return 1
    if (child := os.fork()) == 0:
        try: p.where(3.1, 0.0)
        except kapitza.SceneError as error: os._exit(7 if "was in use" in str(error) else 1)
        os._exit(2)
    children.append(child)
    return 0
pause = p._library.ffi.callback("kapitza_pause", look)
def work():
    p._library.lib.kapitza_set_pause(pause, p._library.ffi.NULL)
    try: p.map(np.zeros(1000), 0.5, 10**7)
    except KeyboardInterrupt: pass
thread = threading.Thread(target=work)
thread.start(); thread.join()
print(os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]))
""")
    assert done.stdout.split() == ["0", "7"], done


FAULTS = {"where": "w = p.where(np.linspace(-3, 3, 300), 0.3); found = w.attractor.values.tolist()",
          "basin": "found = p.basin(80, (-2, 2, 80)).attractor.values.tolist()",
          "map": "found = p.map(np.linspace(-3, 3, 100), 0.3, 5, tangent=True).tangent.tolist()"}


@pytest.mark.parametrize("call", FAULTS)
def test_every_allocation_is_refused_in_turn(call):
    """A MemoryError each, and the next call is right."""
    code = f"""
import ctypes
fail = ctypes.CDLL(os.environ["LD_PRELOAD"])
fail.kz_fail_count.restype = ctypes.c_longlong
p = kapitza.Pendulum({', '.join(f'{name}={value}' for name, value in FIG12.items())})
fail.kz_fail_at(ctypes.c_longlong(2**62))
{FAULTS[call]}
wanted, most = found, fail.kz_fail_count()
step = max(1, most // 20)
refused = 0
for place in [*range(1, min(most, 16)), *range(16, most, step)]:
    p = kapitza.Pendulum({', '.join(f'{name}={value}' for name, value in FIG12.items())})
    fail.kz_fail_at(ctypes.c_longlong(place))
    try:
        {FAULTS[call]}
    except MemoryError:
        refused += 1
    fail.kz_fail_at(ctypes.c_longlong(2**62))
    {FAULTS[call]}
    assert found == wanted, place
print(refused > 10, most)
"""
    done = run(code, timeout=600, LD_PRELOAD=str(PROGRAM.parent / "tests" / "failing_memory.so"),
               KZ_FAIL_CALLERS="libkapitza")
    assert done.stdout.startswith("True"), done


def test_memory_stays_where_it_was():
    done = run("""
import resource
p = kapitza.Pendulum(Q=5, Omega=11, epsilon=0.3)
def work(n):
    for _ in range(n):
        p.basin(20, (-2, 2, 20)); p.where(np.linspace(-3, 3, 100), 0.3); p.attractors()
work(50)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
work(300)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
""")
    assert int(done.stdout) < 4000, done  # kB
