"""Numbers at the limits: accurate, or refused with advice, never silently wrong (docs/validation/extremes.md)."""

import math

import numpy as np
import pytest
import yaml
from conftest import ROOT, refused_scene, run_scene, settings

SMALL = ROOT / "scenes" / "small.yaml"
GRID = ["basin.theta.count=16", "basin.velocity.count=16", "basin.attractors.starts=256", "basin.method=direct",
        "numerics.scheme=split6", "basin.icm={theta: 32, velocity: 32}"]
def pendulum(k=0.01, beta=0.05, m=0.3):
    return f"pendulum={{k: {k!r}, damping: {beta!r}, m: {m!r}}}"


def window(theta=None, velocity=None):
    rows = [("theta", theta), ("velocity", velocity)]
    return [f"basin.{name}={{min: {row[0]!r}, max: {row[1]!r}, count: {row[2]}}}" for name, row in rows if row]


@pytest.fixture
def model(kapitza, tmp_path):
    """model(texts of settings...) -> (labels, names of their attractors, standard output, attributes of /basin)."""

    def call(*texts, status=0):
        words = settings(*GRID, *texts)
        if status != 0:
            return refused_scene(kapitza, tmp_path, SMALL, *words)
        result, said = run_scene(kapitza, tmp_path, SMALL, *words)
        basin, names = result.group("basin"), [str(name) for name in result.group("attractors")["name"].values]
        return basin["attractor"].values, names, said, basin.attrs

    return call


def ends(labels, names):
    """The names that own cells; None = not settled."""
    return {names[label] if label >= 0 else None for label in np.unique(labels)}


# A scene whose steps are too coarse is refused before modelling, with a number of steps that would do, and that number
# does.
REFUSED = {
    "speed 1e3": [*window(velocity=(-1e3, 1e3, 16))],
    "m = 100": [pendulum(m=100.0)],
    "k = 1e4": [pendulum(k=1e4)],
    "Omega = 1e-3": ["pendulum={quality_factor: 5, drive_frequency: 1e-3, drive_amplitude: 0.3}"],
    "beta = 50 with rk4": [pendulum(beta=50.0), "numerics={scheme: rk4}"],
    "beta = 1e3 with rk4": [pendulum(beta=1e3), "numerics={scheme: rk4}"],
    "beta = 1e4": [pendulum(beta=1e4)],
    "one step of split6": ["numerics.steps_per_period=1"],
    "one step of split6 at m = 1": [pendulum(m=1.0), "numerics.steps_per_period=1"],
    "one step of rk4": ["numerics={scheme: rk4, steps_per_period: 1}"],
}
DEAR = ("beta = 1e4", "k = 1e4", "beta = 1e3 with rk4", "one step of split6 at m = 1", "m = 1e4")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.extensive] * (name in DEAR))
                                  for name in REFUSED])
def test_refused_with_the_steps_that_would_do(kapitza, model, name, tmp_path):
    message = model(*REFUSED[name], status=2)
    assert "numerics.steps_per_period" in message and ("rad after one drive period" in message or "diverge" in message)
    enough = int(message.rsplit(";", 1)[1].split()[0])
    scheme = [setting for setting in REFUSED[name] if "scheme" in setting]
    words = settings(*GRID, *(text for text in REFUSED[name] if text not in scheme))
    names = {"numerics": scheme[0].split("scheme: ")[1].split(",")[0].rstrip("}") if scheme else "split6"}
    steps = f"numerics={{scheme: {names['numerics']}, steps_per_period: {enough}}}"
    accepted = kapitza("run", SMALL, *words, "--set", steps, "--time-limit", "1e-3", folder=tmp_path, status=75)
    assert "time limit" in accepted.stderr


HOPELESS = {
    "m = 1e4": [pendulum(m=1e4)],
    "beta = 1e300": [pendulum(beta=1e300)],
}


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.extensive] * (name in DEAR))
                                  for name in HOPELESS])
def test_refused_where_no_steps_help(model, name):
    message = model(*HOPELESS[name], status=2)
    assert "not even" in message and "slower starts" in message


# Scenes whose end is known from theory: every settled cell ends on `down`, or where the settings say.
KNOWN = {
    "m = 0": ([pendulum(m=0.0)], {"down"}),
    "m = 1e-300": ([pendulum(m=1e-300)], {"down"}),
    "m = -1e-300": ([pendulum(m=-1e-300)], {"down"}),
    "m = 1e-8": ([pendulum(m=1e-8)], {"down"}),
    "m = 0, gravity upward": ([pendulum(k=-0.01, m=0.0)], {"inverted"}),
    "denormal m": ([pendulum(m=5e-324)], {"down"}),
    "denormal k": ([pendulum(k=5e-324), "basin.max_periods=50"],
                   {"rotation +1/1", "rotation -1/1", None, "down", "inverted"}),
    "beta = 40": ([pendulum(beta=40.0), "basin.max_periods=20000"], {"down"}),
    "beta = 40 with rk4": ([pendulum(beta=40.0), "basin.max_periods=20000", "numerics={scheme: rk4}"], {"down"}),
    "beta = 1": ([pendulum(k=0.1, beta=1.0), "basin.max_periods=5000"], {"down"}),
    "Omega = 1e4, Q = 20": (["pendulum={quality_factor: 20, drive_frequency: 1e4, drive_amplitude: 2.8e-4}",
                             "basin.max_periods=300", "basin.attractors.starts=16"], {None}),
    "Omega = 1e8": (["pendulum={quality_factor: 5, drive_frequency: 1e8, drive_amplitude: 2.8e-8}",
                     "basin.max_periods=300", "basin.attractors.starts=16"], {None}),
    "k = 0, m = 0": ([pendulum(k=0.0, m=0.0), "basin.max_periods=100", "basin.attractors.starts=2"], {None}),
    "starts at rest below": ([*window((-1e-9, 1e-9, 4), (-1e-9, 1e-9, 4))], {"down"}),
    "velocities of 1e-300": ([*window((-0.1, 0.1, 4), (-1e-300, 1e-300, 4))], {"down"}),
    "velocities of 1e-307": ([*window((-0.1, 0.1, 4), (-1e-307, 1e-307, 4))], {"down"}),
    "one cell": (["basin.theta.count=1", "basin.velocity.count=1"], {"down"}),
    "a window far from every attractor": ([*window((0.5, 0.6, 8), (1.9, 1.95, 8))],
                                          {"down", "inverted", "rotation +1/1", "rotation -1/1", "rotation +2/6",
                                           "rotation -2/6", "down 6-nodding"}),
}


@pytest.mark.parametrize("name", KNOWN)
def test_ends_as_theory_says(model, name):
    texts, allowed = KNOWN[name]
    labels, names, text, attributes = model(*texts)
    assert ends(labels, names) <= allowed
    assert attributes["step_error"] < 1e-4 and "warning: at speeds" not in text


@pytest.mark.parametrize("weak", [pendulum(beta=1e-12), pendulum(beta=1e-300),
                                  "pendulum={quality_factor: 5, drive_frequency: 1e8, drive_amplitude: 2.8e-8}"])
def test_damping_too_weak_settles_nothing(model, weak):
    """That it is warned of before the work: test_few_periods_are_warned_of_before_the_work."""
    labels, names, _, _ = model(weak, "basin.max_periods=100", "basin.attractors.starts=8")
    assert "chaotic" not in names
    assert (labels == -1).all()


# Other studies are tried with their own numerics and speeds, too: scene; key that the message stands at; what it says.
SPRING = "pendulum: {k: 0.01, damping: 0.05, m: 0.3}\n"
TRIED = {
    "attractors": (SPRING + "attractors: {velocity: {min: -1e3, max: 1}}\n", "2:24: attractors.velocity",
                   "steps or more"),
    "steps of the scene": ("numerics: {steps_per_period: 1}\n" + SPRING + "attractors: {velocity: {min: -1, max: 1}}\n",
                           "1:30: numerics.steps_per_period", "steps or more"),
    "orbit": ("numerics: {scheme: rk4}\npendulum: {k: 0, damping: 1e3, m: 0}\norbit: {start: {theta: 1, velocity: "
              "0}}\n",
              "3:16: orbit.start", "diverge"),
    "last value of a sweep": (SPRING + "sweep: {parameter: m, min: 0.1, max: 100, count: 3, measure: [attractors]}\n",
                              "2:8: sweep", "at m = 100, with"),
    "releases without damping": (
        "pendulum: {k: 0.01, damping: 0, m: 100}\nsweep: {parameter: m, min: 1, max: 100, count: 3, "
                                 "measure: [release_angle]}\n", "2:8: sweep", "at m = 100, with"),
    "first value of a sweep": (
        "pendulum: {quality_factor: 5, drive_frequency: 1, drive_amplitude: 0}\nsweep: {parameter: "
                               "drive_frequency, min: 1e-3, max: 10, count: 99, measure: [attractors]}\n", "2:8: sweep",
                               "at drive_frequency = 0.001, with"),
    "reference of a trade-off": ("numerics: {steps_per_period: 9000}\n" + SPRING
                                 + "basin: {velocity: {min: -1e4, max: 1e4}}\n"
                             "tradeoff: {samples: 10}\n", "3:19: basin.velocity", "for reference labels"),
    "reference of an accuracy": (SPRING + "basin: {velocity: {min: -1e4, max: 1}, accuracy: 0.9}\n",
                                 "2:19: basin.velocity",
                             "for reference labels"),
    "reference without end": (
        "pendulum: {k: 9e6, damping: 0.05, m: 0.3}\nbasin: {velocity: {min: -1, max: 1}, accuracy: 0.9}\n",
                          "2:19: basin.velocity", "for reference labels"),
}


# The commands share the check; that of a reference takes seconds.
@pytest.mark.parametrize("command, name", [
    pytest.param(command, name, marks=[pytest.mark.extensive] * (name == "reference of a trade-off"))
    for name in TRIED for command in ("run", "check") if command == "check" or "reference" not in name])
def test_every_study_is_tried_beforehand(kapitza, tmp_path, command, name):
    text, place, said = TRIED[name]
    scheme = () if "scheme" in text or "accuracy" in text else ("--set", "numerics.scheme=split6")
    line = refused_scene(kapitza, tmp_path, text, *scheme, command=command)
    assert line.startswith(f"kapitza: error: s.yaml:{place}: ") and said in line, line


def test_an_option_at_fault_is_named(kapitza, tmp_path):
    done = kapitza("check", SMALL, "--set", "numerics.scheme=split6", "--set", "numerics.steps_per_period=1",
                   folder=tmp_path, status=2)
    assert done.stderr.startswith("kapitza: error: --set numerics.steps_per_period=1: numerics.steps_per_period: with")


def test_attractors_and_sweeps_warn_of_loose_steps(kapitza, tmp_path):
    studies = {"at speeds from 25 to 50": "attractors: {velocity: {min: -50, max: 50}, starts: 8}\n",
               "at m = 8, at speeds from": "sweep: {parameter: m, min: 0.1, max: 8, count: 2, measure: [strobe], "
                                           "transient: 1}\n"}
    for said, study in studies.items():
        _, summary = run_scene(kapitza, tmp_path, SPRING + study, "--set", "numerics.scheme=split6")
        assert f"warning: {said}" in summary and "steps or more" in summary, summary


@pytest.mark.extensive
def test_settings_that_do_not_carry_are_said(kapitza, tmp_path):
    """Their labels are random: measured as wrong, and named in a warning."""
    basin = ("basin: {theta: {count: 8}, velocity: {min: -100, max: 100, count: 8}, method: direct, attractors: "
             "{starts: 16}}\n")
    result, said = run_scene(kapitza, tmp_path, f"numerics: {{scheme: split6, steps_per_period: 96}}\n{SPRING}{basin}"
                             "tradeoff: {samples: 64, settings: [direct-8, direct-96]}\n")
    assert "warning: these settings have too few steps for the speeds of this window: direct-8\n" in said
    trade = result.group("tradeoff")
    wrong = dict(zip(map(str, trade["label"].values), trade["wrong"].values, strict=True))
    assert wrong["direct-8"] > 0.2 > wrong["direct-96"]


def test_no_damping_is_no_attractor(model):
    labels, names, text, attributes = model(pendulum(beta=0.0))
    assert (labels == -1).all() and names == [] and "without damping there are no attractors" in text
    assert math.isnan(attributes["step_error"])


def test_fast_starts_are_warned_of_by_their_class(model):
    _, _, text, attributes = model(*window(velocity=(-50, 50, 16)))
    assert "warning: at speeds from 25 to 50" in text and "48 steps or more" in text
    assert 1e-3 < attributes["step_error"] < 0.1
    labels, names, text, attributes = model(*window(velocity=(-50, 50, 16)), "numerics.steps_per_period=48")
    assert "warning: at speeds" not in text and attributes["step_error"] < 1e-4


def test_coarse_tables_are_warned_of(model):
    _, _, text, attributes = model("basin.method=icm", "basin.icm={theta: 250, velocity: 250, interpolation: linear}")
    assert "warning: the map table has an error of" in text and 1e-4 < attributes["table_error"] < 0.1
    _, _, text, attributes = model("basin.method=icm", "basin.icm={theta: 250, velocity: 250}")
    assert "warning" not in text and attributes["table_error"] < 1e-4


@pytest.mark.parametrize("method", ["icm", "direct"])
def test_starts_on_the_seam_and_on_unstable_points(model, method):
    """Rows at theta = pi (inverted does not attract at m = 0.05) and one cell beside: all labelled, mirrored, and
    down."""
    texts = [pendulum(m=0.05), f"basin.method={method}", "basin.icm={theta: 200, velocity: 200}",
             "basin.max_periods=5000"]
    labels, names, _, _ = model(*texts, *window((-math.pi, math.pi, 15), (-1e-3, 1e-3, 15)))
    assert ends(labels, names) <= {"down", None}
    assert (labels == -1).sum() <= 1  # rest at the centre may stay where it is
    assert (labels == labels[::-1, ::-1]).all()


@pytest.mark.parametrize("method", ["icm", "direct"])
def test_rest_where_rest_is_unstable_reaches_no_attractor(model, method):
    """(0, 0) and (pi, 0) are their own mirror images: the rotation in which rounding would make them end is not."""
    texts = [pendulum(m=0.52), f"basin.method={method}", "basin.icm={theta: 250, velocity: 250}"]
    labels, _, _, _ = model(*texts, *window((-math.pi / 2, 1.5 * math.pi, 2), (-1, 1, 3)))
    assert labels[1].tolist() == [-1, -1] and (labels[[0, 2]] >= 0).all()


@pytest.mark.parametrize("theta, velocity",
                         [((-math.pi, math.pi, 1), (-2, 2, 10**6)), ((-math.pi, math.pi, 10**6), (-2, 2, 1))])
def test_a_window_of_one_row_of_cells_is_labelled(model, theta, velocity):
    labels, names, _, attributes = model(*window(theta, velocity), "basin.method=icm",
                                         "basin.icm={theta: 1000, velocity: 1000}")
    assert labels.shape == (velocity[2], theta[2]) and (labels >= 0).mean() > 0.99
    assert math.isfinite(attributes["basin_entropy"])


def test_periods_beyond_max_period_stay_unsettled(model):
    """The two 6-cycles are not looked for: their cells are unsettled, nothing else changes its name."""
    grid = ["basin.theta.count=40", "basin.velocity.count=40", "basin.max_periods=500", "basin.attractors.starts=128"]
    few, names, _, _ = model("basin.attractors.max_period=5", *grid)
    every, known, _, _ = model(*grid)
    assert not any("6" in name for name in names) and any("6" in name for name in known)
    for row in range(40):
        for a, b in zip(few[row], every[row], strict=True):
            assert (names[a] == known[b]) if a >= 0 else b < 0 or "6" in known[b]


@pytest.mark.parametrize("beta", [0.0, 1e-12])
def test_attractors_alone_without_damping(kapitza, tmp_path, beta):
    result, _ = run_scene(kapitza, tmp_path, {"pendulum": {"k": 0.01, "damping": beta, "m": 0.3},
                                              "attractors": {"velocity": {"min": -1, "max": 1}, "starts": 8}})
    assert result.group("attractors")["period"].shape == (0,)


def test_one_period_and_one_start(model):
    labels, _, _, _ = model("basin.max_periods=1", "basin.attractors.starts=1")
    assert (labels >= -1).all()


FEW = ["basin.theta.count=4", "basin.velocity.count=4", "basin.attractors.starts=8", "basin.attractors.max_period=2"]


# A period limit that the scene does not give follows from the damping; one that leaves most motions unsettled is named
# before the work.
@pytest.mark.extensive
def test_periods_follow_from_the_damping(kapitza, tmp_path):
    def check(*texts):
        done = kapitza("check", SMALL, "--all", *settings(*GRID, *FEW, *texts), folder=tmp_path)
        resolved = yaml.safe_load(done.stdout.split("\n\n")[1])
        return resolved["basin"]["max_periods"], [line for line in done.stdout.splitlines()
                                                  if line.startswith("warning")]

    assert check() == (2000, [])
    periods, warnings = check("pendulum.quality_factor=80")
    assert 20 * 140 < periods < 60 * 140 and not warnings
    sweep = "sweep={parameter: quality_factor, min: 5, max: 80, count: 2, measure: [release_angle]}"
    assert check(sweep) == (periods, [])
    limit, (warning,) = check("pendulum.quality_factor=80", "basin.max_periods=500")
    assert limit == 500 and warning.startswith("warning: basin.max_periods: ") and f"{periods}" in warning
    words = settings(*GRID, "pendulum.quality_factor=1e7")
    assert "warning: basin.max_periods: " in kapitza("run", SMALL, *words, "--time-limit", "1e-6", folder=tmp_path,
                                                     status=75).stderr


def test_few_periods_are_warned_of_before_the_work(kapitza, tmp_path):
    words = settings(*GRID, "basin.max_periods=3", "basin.attractors.starts=1")
    done = kapitza("run", SMALL, "-o", "x.h5", *words, folder=tmp_path)
    assert done.stderr.startswith("warning: basin.max_periods: ") and "warning: basin.max_periods" not in done.stdout


def test_weakly_damped_motions_settle_without_a_word_on_periods(model):
    labels, _, _, attributes = model("pendulum.quality_factor=100", "basin.attractors.starts=64", "basin.theta.count=6",
                                     "basin.velocity.count=6", "basin.attractors.max_period=4")
    assert attributes["max_periods"] == 7100 and (labels >= 0).mean() > 0.8


# Pendulums and starts that are not followed: refused in one line as the scene is read.
BEYOND = {
    "speed 1e6": (window(velocity=(-1e6, 1e6, 16)), "basin.velocity.min"),
    "speed 1e9": (window(velocity=(0, 1e9, 16)), "basin.velocity.max"),
    "m = 1e11": ([pendulum(m=1e11)], "pendulum"),
    "m = 6e11, which overflowed a table": ([pendulum(m=6e11)], "pendulum"),
    "m = 1e14": ([pendulum(m=1e14)], "pendulum"),
    "m = 1e300": ([pendulum(m=1e300)], "pendulum"),
    "m = -1e300, k = 1e300": ([pendulum(m=-1e300, k=1e300)], "pendulum"),
    "Omega = 1e-6": (["pendulum={quality_factor: 5, drive_frequency: 1e-6, drive_amplitude: 0.3}"], "pendulum"),
    "a sweep up to m = 1e12": ([
        "sweep={parameter: drive_amplitude, min: 0.1, max: 1e12, count: 3, measure: [attractors]}"], "sweep.max"),
}


# The commands share the reading of a scene.
@pytest.mark.parametrize("command, name", [*((["check"], name) for name in BEYOND), (["run"], "m = 1e300"),
                                           (["where", 1, 0], "m = 1e300")])
def test_refused_as_the_scene_is_read(kapitza, name, command, tmp_path):
    texts, key = BEYOND[name]
    assert f": {key}: " in refused_scene(kapitza, tmp_path, SMALL, *command[1:], *settings(*texts), command=command[0])


def test_a_motion_that_is_lost_while_steps_are_chosen(kapitza, tmp_path):
    """Too few steps carry the velocity beyond the doubles: that crashed."""
    kapitza("run", SMALL, "--set", "numerics.tolerance=1e-6", "--set", pendulum(m=100.0), "--time-limit", "1e-6",
            folder=tmp_path, status=75)
