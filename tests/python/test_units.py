"""Pictures in the units of a laboratory: what a tick says is the value of its place in degrees, seconds, rad/s or Hz."""

import re

import numpy as np
import pytest
from conftest import plot
from kapitza import Result
from kapitza.plots import basin, orbit, potential, sweep

SI = {"mass": 0.1, "radius": 0.2, "inertia": 0.004, "friction": 0.002, "gravity": 9.81, "pivot_amplitude": 0.06, "frequency": 12.25}
OMEGA = 2 * np.pi * 12.25


@pytest.fixture(scope="module")
def result(model):
    return model(SI, basin={"theta": {"count": 12}, "velocity": {"min": -2, "max": 2, "count": 10}, "attractors": {"starts": 64}},
                 orbit={"start": {"theta": 2.9, "velocity": 0}, "periods": 30}, potential={"drive_amplitudes": [0.3]})


def page(kind, result, *words):
    """The figure of a kind with these options, drawn."""
    figure = kind.draw(result, kind.parse_arguments(["x.h5", *words]))
    figure.draw_without_rendering()
    return figure


def ticks(axis):
    """[(place, number on its label)] of the ticks that are in sight."""
    low, high = sorted(axis.get_view_interval())
    labels = [label.get_text().replace("−", "-").rstrip("°") for label in axis.get_ticklabels()]
    texts = zip(axis.get_majorticklocs(), labels, strict=True)
    power = re.compile(r"10\^\{(-?\d+)\}")
    seen = [(place, text) for place, text in texts if low <= place <= high]
    return [(place, 10.0 ** int(power.search(text)[1]) if power.search(text) else float(text)) for place, text in seen]


def assert_scaled(axis, factor, label):
    shown = ticks(axis)
    assert len(shown) >= 3 and label in axis.get_label_text()
    assert [number for _, number in shown] == pytest.approx([place * factor for place, _ in shown], rel=1e-5, abs=1e-9)


def test_a_plane_in_degrees_and_radians_a_second(result):
    axes = page(basin, result, "--degrees", "--si").axes[0]
    assert_scaled(axes.xaxis, 180 / np.pi, "angle")
    assert_scaled(axes.yaxis, OMEGA, "(rad/s)")
    times = page(basin, result, "--si", "--quantity", "settling_time").axes[0].child_axes[0]
    assert_scaled(times.yaxis, 1 / 12.25, "(s)")


def test_an_orbit_in_seconds_and_hertz(result):
    axes = {panel.get_label(): panel for panel in page(orbit, result, "--degrees", "--si").axes}
    assert_scaled(axes["time"].xaxis, 1 / 12.25, "time (s)")
    assert_scaled(axes["phase"].yaxis, OMEGA, "(rad/s)")
    assert_scaled(axes["spectrum"].xaxis, 12.25, "(Hz)")
    assert_scaled(axes["spectrum"].yaxis, 180 / np.pi, "(deg)")


def test_potentials_and_strobe_points_in_degrees(result, swept):
    assert_scaled(page(potential, result, "--degrees").axes[1].xaxis, 180 / np.pi, "angle")
    for panel in page(sweep, Result(swept), "--view", "strobe", "--degrees").axes:
        assert_scaled(panel.yaxis, 180, "strobe")
    assert_scaled(page(sweep, Result(swept), "--view", "flutter", "--degrees").axes[1].yaxis, (180 / np.pi) ** 2, "degrees²")


def test_si_needs_a_scene_in_si(small_result, tmp_path):
    done = plot("basin", small_result, "-o", tmp_path / "x.png", "--si")
    assert done.returncode == 1 and "its scene is not in SI units" in done.stderr and not list(tmp_path.iterdir())
