"""Pendulums and starts that are not followed: refused in one line as the scene is read; nothing crashes, nothing lasts."""

import pytest
from test_extremes import SMALL, pendulum, window

BEYOND = {
    "speed 1e6": (window(velocity=(-1e6, 1e6, 16)), "basin.velocity.min"),
    "speed 1e9": (window(velocity=(0, 1e9, 16)), "basin.velocity.max"),
    "m = 1e11": ([pendulum(m=1e11)], "pendulum"),
    "m = 6e11, which overflowed a table": ([pendulum(m=6e11)], "pendulum"),
    "m = 1e14": ([pendulum(m=1e14)], "pendulum"),
    "m = 1e300": ([pendulum(m=1e300)], "pendulum"),
    "m = -1e300, k = 1e300": ([pendulum(m=-1e300, k=1e300)], "pendulum"),
    "Omega = 1e-6": (["pendulum={quality_factor: 5, drive_frequency: 1e-6, drive_amplitude: 0.3}"], "pendulum"),
    "a sweep up to m = 1e12": (["sweep={parameter: drive_amplitude, min: 0.1, max: 1e12, count: 3, measure: [attractors]}"], "sweep.max"),
}


@pytest.mark.parametrize("command", [["check"], ["run"], ["where", 1, 0]], ids=lambda command: command[0])
@pytest.mark.parametrize("name", BEYOND)
def test_refused_as_the_scene_is_read(kapitza, name, command, tmp_path):
    settings, key = BEYOND[name]
    words = [word for setting in settings for word in ("--set", setting)]
    done = kapitza(command[0], SMALL, *command[1:], *words, folder=tmp_path, status=2)
    assert f": {key}: " in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert not list(tmp_path.iterdir())


def test_a_motion_that_is_lost_while_steps_are_chosen(kapitza, tmp_path):
    """Too few steps carry the velocity beyond the doubles: that crashed."""
    kapitza("run", SMALL, "--set", "numerics.tolerance=1e-6", "--set", pendulum(m=100.0), "--time-limit", "1e-6",
            folder=tmp_path, status=75)
