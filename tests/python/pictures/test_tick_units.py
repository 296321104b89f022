"""Pictures in the units of a laboratory: what a tick says is the value of its place in degrees, seconds, rad/s or
Hz."""

import re
from types import SimpleNamespace

import kapitza
import numpy as np
import pytest
import xarray
from conftest import plot
from kapitza import Result, units
from kapitza.explorer.scene import Start
from kapitza.plots import basin, chart, orbit, potential, sweep
from kapitza.plots.units import group_beside
from kapitza.report.page import report

SI = {"mass": 0.1, "radius": 0.2, "inertia": 0.004, "friction": 0.002, "gravity": 9.81, "pivot_amplitude": 0.06,
      "frequency": 12.25}
OMEGA = 2 * np.pi * 12.25


@pytest.fixture(scope="module")
def result(model):
    return model(SI, basin={"theta": {"count": 12}, "velocity": {"min": -2, "max": 2, "count": 10},
                            "attractors": {"starts": 64}},
                 orbit={"start": {"theta": 2.9, "velocity": 0}, "periods": 30}, potential={"drive_amplitudes": [0.3]})


def page(kind, result, **options):
    """The figure of a kind with these options, drawn."""
    figure = kind.draw(result, **options)
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


def assert_shows(axis, label, low, high):
    """Ticks say the numbers of their places, over this range."""
    shown = ticks(axis)
    assert len(shown) >= 3 and label in axis.get_label_text()
    assert [number for _, number in shown] == pytest.approx([place for place, _ in shown], rel=1e-5, abs=1e-9)
    assert sorted(axis.get_view_interval()) == pytest.approx([low, high], rel=1e-9)


@pytest.mark.extensive
def test_a_measured_point_lands_on_its_cell(result):
    """Data coordinates are those of the labels: degrees and rad/s, also of dots, legends aside."""
    axes = page(basin, result, degrees=True, si=True).axes[0]
    assert_shows(axes.xaxis, "angle", -180, 180)
    assert_shows(axes.yaxis, "(rad/s)", -2 * OMEGA, 2 * OMEGA)
    (image,) = axes.images
    left, right, low, high = image.get_extent()
    labels, colours = result.labels(si=True, degrees=True), image.get_array()
    seen = {}
    for degrees, speed in ((173.0, 10.0), (3.0, -8.0), (100.0, 130.0), (-100.0, -130.0)):
        column, row = int((degrees - left) / (right - left) * 12), int((speed - low) / (high - low) * 10)
        label = labels.sel(theta=degrees, velocity=speed, method="nearest").item()
        assert result.at(f"{degrees} deg", f"{speed} rad/s")["attractor"] == label
        seen[label] = {tuple(colours[row, column]), *([seen[label].pop()] if label in seen else [])}
    assert all(len(found) == 1 for found in seen.values()) and len(set.union(*seen.values())) == len(seen) >= 2
    dots = [line for line in axes.lines if len(line.get_xdata())]
    assert any(np.any(np.abs(np.abs(line.get_xdata()) - 180) < 1e-6) for line in dots)  # the inverted state


@pytest.mark.extensive
def test_times_in_seconds(result):
    times = page(basin, result, si=True, quantity="settling_time").axes[0].child_axes[0]
    longest = float(result.convergence_times(si=True).where(result.labels(si=True) >= 0).max())
    assert_shows(times.yaxis, "(s,", 1 / 12.25, longest + 1 / 12.25)
    assert longest == pytest.approx(float(result.convergence_times().where(result.labels() >= 0).max()) / 12.25)


@pytest.mark.extensive
def test_an_orbit_in_seconds_and_hertz(result):
    drive, lab = ({panel.get_label(): panel for panel in page(orbit, result, degrees=si, si=si).axes}
                  for si in (False, True))
    for name, axis, label, factor in (("time", "x", "time (s)", 1 / 12.25), ("phase", "y", "(rad/s)", OMEGA),
                                      ("spectrum", "x", "(Hz)", 12.25), ("spectrum", "y", "(deg)", 180 / np.pi)):
        interval = getattr(drive[name], f"{axis}axis").get_view_interval()
        assert_shows(getattr(lab[name], f"{axis}axis"), label, *factor * np.sort(interval))
    assert lab["phase"].lines[0].get_ydata() == pytest.approx(OMEGA * drive["phase"].lines[0].get_ydata())


@pytest.mark.extensive
def test_potentials_and_strobe_points_in_degrees(result, swept):
    assert_shows(page(potential, result, degrees=True).axes[1].xaxis, "angle", 0, 360)
    for panel in page(sweep, Result(swept), view="strobe", degrees=True).axes:
        assert_shows(panel.yaxis, "strobe", *panel.get_ylim())
        angles = np.mod(np.degrees(Result(swept).group("sweep")["strobe_theta"].values), 360)
        assert np.min(panel.lines[0].get_ydata()) == pytest.approx(np.min(angles), abs=20)
    plain, degrees = (page(sweep, Result(swept), view="flutter", degrees=words).axes[1] for words in (False, True))
    assert degrees.lines[0].get_ydata() == pytest.approx((180 / np.pi) ** 2 * plain.lines[0].get_ydata())
    assert "degrees²" in degrees.get_ylabel()


def test_groups_say_their_units(result):
    plain, si = result.group("attractors"), result.group("attractors", si=True, degrees=True)
    assert si["strobe_velocity"].values == pytest.approx(OMEGA * plain["strobe_velocity"].values, nan_ok=True)
    assert si["strobe_theta"].attrs["units"] == "degree" and si["strobe_velocity"].attrs["units"] == "rad s-1"
    assert si["period"].equals(plain["period"])
    assert si["lyapunov"].values == pytest.approx(12.25 * plain["lyapunov"].values, nan_ok=True)
    labels = result.labels(si=True)
    assert labels["velocity"].attrs["units"] == "rad s-1" and labels["theta"].attrs["units"] == "rad"
    assert labels["velocity"].values == pytest.approx(OMEGA * result.labels()["velocity"].values)


def test_what_people_write_behind_a_number():
    assert [units.angle(text) for text in ("175 deg", "175°", "pi/2", "-3 pi/4", "π", "0.5pi", "2.5",
                                           2.5)] == pytest.approx(
        [np.radians(175), np.radians(175), np.pi / 2, -3 * np.pi / 4, np.pi, np.pi / 2, 2.5, 2.5], rel=1e-15)
    assert units.velocity("3 rad/s", 60) == 0.05 and units.velocity("90 deg/s", 1) == pytest.approx(np.pi / 2)
    for wrong in ("up", "3 rad/s"):
        with pytest.raises(ValueError, match="is not an angle"):
            units.angle(wrong)
    with pytest.raises(ValueError, match="not in SI units"):
        units.velocity("3 rad/s", None)


def test_the_explorer_keeps_units_that_are_written():
    """With or without a blank before the unit; what has none is as the program says."""
    start = Start("pendulum: {length: 20cm, frequency: 50 Hz, amplitude: 8 mm, quality_factor: 20, tilt: pi/90}",
                  is_text=True)
    assert start.pendulum() == {"length": "20cm", "frequency": "50 Hz", "amplitude": "8 mm", "quality_factor": 20,
                                "tilt": "pi/90", "gravity": 9.80665}
    assert units.quantity("50Hz", units.HERTZ) == 50
    assert units.written_frequency({"frequency": "3000rpm"}) == pytest.approx(100 * np.pi)


def test_the_footer_says_an_amplitude_in_mm():
    """As the program's messages do; a length in the largest unit of which it is at least one."""
    found = units.si_parameters({"length": 0.2, "pivot_frequency": 100 * np.pi, "pivot_amplitude": 0.012,
                                 "quality_factor": 10})
    assert list(found.values()) == ["length 20 cm", "50 Hz", "amplitude 12 mm", "Q = 10"]


ROD = {"length": "20 cm", "frequency": "50 Hz", "amplitude": "8 mm", "quality_factor": 20, "tilt": 0}
STROBE = {"count": 2, "measure": ["strobe"], "transient": 1, "samples": 1}


@pytest.mark.parametrize(("key", "ends", "unit", "written", "stored"), [
    ("amplitude", ("6 mm", "0.9 cm"), "mm", [6, 9], [0.006, 0.009]),
    ("amplitude", (0.006, "9mm"), "mm", [6, 9], [0.006, 0.009]),
    ("amplitude", (0.006, 0.009), "m", [0.006, 0.009], [0.006, 0.009]),
    ("frequency", ("3000 rpm", "55 Hz"), "rpm", [3000, 3300], [50, 55]),
    ("tilt", ("2e0°", "5 deg"), "°", [2, 5], np.radians([2, 5])),
])
def test_a_sweep_keeps_the_unit_that_is_written(key, ends, unit, written, stored):
    """In the text of the run, and on the axis of its picture; the file has units of the key."""
    found = kapitza.run({"pendulum": ROD, "sweep": STROBE | {"parameter": key, "min": ends[0], "max": ends[1]}},
                        progress=False)
    assert f"sweep of {key} in {unit}, 2 values from {written[0]:g} to {written[1]:g}" in found.summary
    assert found.group("sweep")["value"].values == pytest.approx(stored, rel=1e-15)
    value = found.group("sweep", written=True)["value"]
    assert value.values == pytest.approx(written, rel=1e-15) and value.attrs["units"] == unit
    figure = page(sweep, found)
    assert figure.axes[-1].get_xlabel() == f"{key} ({unit})"
    assert figure.axes[-1].get_xlim() == pytest.approx(tuple(written))


def test_a_plane_keeps_the_units_that_are_written():
    """Its curves of an atlas too, whose scene may have other ones."""
    plan = {"x": {"parameter": "frequency", "min": "45 Hz", "max": "3000 rpm", "count": 2},
            "y": {"parameter": "amplitude", "min": "2 mm", "max": "8 mm", "count": 2},
            "measure": ["ends"], "ends": {"theta": ["170°"], "max_periods": 3}}
    found = kapitza.run({"pendulum": ROD, "sweep": plan}, progress=False)
    axes = page(chart, found).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("frequency (Hz)",
                                                      "amplitude (mm)") and axes.get_ylim() == pytest.approx((2, 8))
    drawn, scale = found.group("plane", written=True), {"x": 60.0, "y": 0.01}
    atlas = xarray.Dataset({which: ("point", [0.3]) for which in "xy"},
                           attrs={f"{which}_written_scale": 9.0 for which in "xy"})
    drawn.attrs |= {f"{which}_written_{name}": value for which in "xy" for name,
                    value in (("scale", scale[which]), ("units", "u"))}
    beside = group_beside(SimpleNamespace(group=lambda _: atlas), "atlas", drawn)
    assert float(beside["x"][0]) == pytest.approx(0.005) and float(beside["y"][0]) == pytest.approx(30)


def test_along_a_frequency_every_value_has_its_own_second():
    """One period lasts 1/50 s at 50 Hz and 1/100 s at 100 Hz."""
    periods = {"long_name": "return time, in drive periods", "units": "1"}
    line = xarray.Dataset({"time": (("attractor", "value"), [[100.0, 100.0]], periods),
                           "alone": ("attractor", [3.0], periods)},
                          {"value": [50.0, 100.0]}, {"parameter": "frequency"})
    in_si = units.in_units(line, 2 * np.pi * 50)
    assert in_si["time"].values[0] == pytest.approx([2.0, 1.0]) and in_si["time"].attrs["units"] == "s"
    assert in_si["alone"].equals(line["alone"]) and units.with_unit("alone", in_si["alone"]) == "alone (drive periods)"


def test_the_texts_of_a_run_are_in_si(undrawn):
    window = {"theta": {"count": 2}, "velocity": {"min": -0.01, "max": 0.01, "count": 2}}
    plan = {"names": ["return_time", "reactivity"], "starts": 8, "velocity": {"min": -0.01, "max": 0.01}}
    orbit = {"start": {"theta": 1, "velocity": 1.05}, "periods": 20}
    scene = {"pendulum": ROD, "basin": window | {"attractors": {"starts": 8}}, "measures": plan, "orbit": orbit}
    found = kapitza.run(scene, progress=False)
    line = re.search(r"at (\d+)/(\d+) of the drive frequency \(([\d.]+) Hz\)", found.summary)
    assert float(line[3]) == pytest.approx(50 * int(line[1]) / int(line[2]), rel=1e-3)
    time = found.group("measures", si=True)["return_time"]
    assert re.search(rf"  return_time +{time.values[0]:.6g} .* s\n  reactivity +[\d. ]+\n",
                     found.summary) and time.attrs["units"] == "s"
    most = int(re.search(r"settled? within (\d+) drive periods", found.summary)[1])
    assert f"{most} drive periods ({most / 50:.4g} s)." in found.summary
    text = report(found)
    assert f"{time.values[0]:.4g} s" in text and "Lyapunov exponent (1/s)" in text
    assert "length 20 cm, 50 Hz, amplitude 8 mm" in text


@pytest.mark.extensive
def test_starts_are_looked_up(result, small_result):
    """The angle is wrapped; outside the window there is no answer. `labels().sel(..., method="nearest")` clamps."""
    again = result.at(["190 deg", "-170 deg", np.radians(190) - 20 * np.pi], 0.1)
    assert len(again) == 3 and again["attractor"].nunique() == 1
    assert again["theta"].values == pytest.approx(np.radians(-170))
    one = result.at("190 deg", 0.1)
    assert one["name"] == again["name"][0]
    assert one["attractor"] == result.labels().sel(theta=np.radians(-170), velocity=0.1, method="nearest").item()
    for theta, velocity in ((0, 2.01), (0, "-154 rad/s"), (np.nan, 0)):
        with pytest.raises(ValueError, match="outside the window"):
            result.at(theta, velocity)
    with pytest.raises(ValueError, match="not in SI units"):
        Result(small_result).at(0, "3 rad/s")


def test_si_needs_a_scene_in_si(small_result, tmp_path):
    done = plot("basin", small_result, "-o", tmp_path / "x.png", "--si")
    assert done.returncode == 1 and "its scene is not in SI units" in done.stderr and not list(tmp_path.iterdir())
