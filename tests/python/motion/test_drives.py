"""Drives beyond the sine: harmonics, wave forms, a tilted or elliptic path of the pivot, torque."""

import itertools
import json
import math

import kapitza as kapitza_package
import numpy as np
import pytest
from conftest import ROOT, flown, refused_scene, with_extensive
from drives import LINEAR, PENDULUM, RIGS, SMOOTH, WINDOW, period, run
from kapitza import Pendulum, manifolds
from serving import Server


@pytest.fixture(scope="module", params=with_extensive(["square", "tilted"], RIGS))
def rig(request, kapitza, tmp_path_factory):
    keys, force = RIGS[request.param]
    basin = {**WINDOW, "method": "exact", "attractors": {"starts": 256}}
    return force, request.param, run(kapitza, tmp_path_factory.mktemp("rig"),
                                     {"pendulum": {**PENDULUM, **keys}, "basin": basin})


def test_published_cycles_obey_the_equation(rig):
    """An integration written here carries each strobe point to the next."""
    force, _, file = rig
    found = file["attractors"]
    for i, n in enumerate(found["period"][:]):
        points = np.column_stack([found["strobe_theta"][i, :n], found["strobe_velocity"][i, :n]])
        for j in range(n):
            theta, velocity = period(force, points[j])
            expected = points[(j + 1) % n]
            assert abs(math.remainder(theta - expected[0], 2 * math.pi)) < 1e-9 and abs(velocity - expected[1]) < 1e-9


def test_attractors_have_mirror_images_where_the_pendulum_is_mirrored(rig):
    _, name, file = rig
    mirror = file["attractors/mirror"][:]
    if name in ("tilted", "ellipse", "torque"):
        assert (mirror == -1).all()
    else:
        assert (mirror >= 0).all() and (mirror[mirror] == np.arange(len(mirror))).all()
        labels = file["basin/attractor"][:]
        image = np.append(mirror, -1)[labels[::-1, ::-1]]
        assert (labels == image).mean() > 0.99  # flagged cells have two candidates


@pytest.mark.extensive
def test_samples_are_the_harmonics_that_they_hold(kapitza, tmp_path):
    """Cosine of order 1 and sine of order 2, 8 samples; 64 samples of a square wave hold more, and what is left is
    told."""
    samples = [math.cos(math.pi * i / 4) + 0.25 * math.sin(math.pi * i / 2) for i in range(8)]
    basin = {"basin": {**WINDOW, "method": "direct", "attractors": {"starts": 256}}}
    labels = [run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **basin})["basin/attractor"][:]
              for keys in ({"waveform": "samples", "samples": samples},
                           {"harmonics": [{"order": 2, "amplitude": 0.25, "phase": -math.pi / 2}]})]
    assert (labels[0] == labels[1]).all()
    square = {"pendulum": {**PENDULUM, "waveform": "samples", "samples": [1] * 16 + [-1] * 32 + [1] * 16}, **basin}
    (tmp_path / "rig.yaml").write_text(json.dumps(square))
    said = kapitza("check", "--all", "rig.yaml", folder=tmp_path).stdout.split("Drive: ")[1]
    times = 2 * math.pi * np.arange(64) / 64
    wave = np.array(square["pendulum"]["samples"], dtype=float)
    amplitude = np.fft.rfft(wave)[:17] / 32
    left = wave - sum((amplitude[j] * np.exp(1j * j * times)).real for j in range(1, 17))
    assert said.startswith("harmonics up to order 15 stand for 64 samples")
    assert abs(float(said.split("off by ")[1].split()[0]) - abs(left).max()) < 0.01


def coefficients(file):
    """The pendulum of a file as a mapping of a scene, from nothing but the numbers that were integrated."""
    group, numbers = file["pendulum"], dict(file["pendulum"].attrs)
    pendulum = {"k": numbers["k"], "damping": numbers["beta"], "m": numbers["m"]}
    pendulum |= {name: [float(value) for value in group[name][:].ravel()] for name in ("vertical", "horizontal")
                 if name in group}
    pendulum |= {name: numbers[name] for name in ("torque", "torque_amplitude") if name in numbers}
    ramp = {name.removeprefix("ramp_"): value for name, value in numbers.items() if name.startswith("ramp_")
            and name != "ramp_strength"}
    return pendulum | ({"ramp": ramp} if ramp else {}), numbers.get("start_phase", 0)


@pytest.mark.parametrize("keys, basin", [
    pytest.param({"tilt": "5 deg", "ellipse": 0.1, "torque": 0.001}, {}, marks=pytest.mark.extensive),
    ({"waveform": "square", "harmonics": [{"order": 2, "amplitude": 0.1, "phase": "50 deg"}], "ramp": SMOOTH},
     {"start_phase": 7.5}),
    ({"waveform": "samples", "samples": [1, 0.3, -0.8, -0.4, 0.1], "tilt": 0.01, "ramp": LINEAR},
     {"start_phase": "-40 deg"}),
    ({"torque_amplitude": 0.7, "drive_amplitude": 0, "torque": 0.01, "ramp": LINEAR}, {"start_phase": 2})])
def test_a_file_holds_every_coefficient_that_was_integrated(kapitza, tmp_path, keys, basin):
    basin = {**WINDOW, **basin, "method": "direct", "attractors": {"starts": 64}}
    file = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, "basin": basin})
    pendulum, phase = coefficients(file)
    (tmp_path / "again").mkdir()
    again = run(kapitza, tmp_path / "again", {"pendulum": pendulum, "basin": {**basin, "start_phase": phase}})
    for group in ("attractors", "basin", "pendulum"):
        assert set(file[group]) == set(again[group])
        for name in file[group]:
            assert (file[group][name][()].tobytes() == again[group][name][()].tobytes()
                    or file[group][name].dtype.kind == "O")
    assert coefficients(again) == (pendulum, phase)


def test_overtones_are_in_proportion_to_the_drive(kapitza, tmp_path):
    """Of order 1 half of m acts as 1.5 m; at each value of a sweep as in a scene of its own."""
    scene = {"pendulum": {"k": 0.0949, "damping": 0.4657, "m": 0.3, "harmonics": [{"order": 1, "amplitude": 0.5}]},
             "basin": {**WINDOW, "method": "direct", "attractors": {"starts": 256}}}
    sweep = {"parameter": "m", "min": 0.3, "max": 0.9662, "count": 2, "measure": ["basin_fractions"], "starts": 256}
    swept = run(kapitza, tmp_path, scene | {"sweep": sweep})
    attracts = swept["sweep/branch_stable"][:] == 1
    share = dict(zip(swept["sweep/branch_name"].asstr()[attracts], swept["sweep/fraction"][-1, attracts], strict=True))
    for pendulum in (scene["pendulum"] | {"m": 0.9662}, {"k": 0.0949, "damping": 0.4657, "m": 1.4493}):
        file = run(kapitza, tmp_path, scene | {"pendulum": pendulum})["attractors"]
        assert all(abs(share[name] - part) < 0.01 for name, part in zip(file["name"].asstr()[:], file["fraction"][:],
                                                                        strict=True))


@pytest.mark.parametrize("keys, rest", [({}, "(for drive_amplitude"),
                                        ({"waveform": "square"}, "Rest inverted: stable (for drive_amplitude from 0.1"),
                                        ({"waveform": "square", "drive_amplitude": 0.05},
                                         "Rest inverted: unstable (stable for drive_amplitude"),
                                        ({"torque": 0.01}, "Rest: none")])
def test_rest_is_told_for_the_drive_that_is_there(kapitza, tmp_path, keys, rest):
    (tmp_path / "rig.yaml").write_text(json.dumps({"pendulum": {**PENDULUM, **keys}, "basin": WINDOW}))
    assert rest in kapitza("check", "--all", "rig.yaml", folder=tmp_path).stdout


@pytest.mark.parametrize(("keys", "images"), [
    ({"k": 0.1, "m": 0.3}, "with a motion theta(t) also -theta(t)"),
    ({"k": 0, "m": 0.3}, "with a motion theta(t) also -theta(t), pi + theta(t + pi)"),
    ({"k": 0.1, "m": 0, "torque_amplitude": 1}, "with a motion theta(t) also -theta(t + pi)"),
    ({"k": 0.1, "m": 0.3, "tilt": 0.1}, "none")])
def test_symmetries_of_the_drive_are_told(kapitza, tmp_path, keys, images):
    scene = {"pendulum": keys | {"damping": 0.1}, "orbit": {"start": {"theta": 1, "velocity": 0}, "periods": 2}}
    (tmp_path / "rig.yaml").write_text(json.dumps(scene))
    line = f"Symmetry: {images}.\n"
    assert line in kapitza("check", "--all", "rig.yaml", folder=tmp_path).stdout
    said = kapitza("run", "rig.yaml", folder=tmp_path).stdout
    assert (line in said) == ("torque_amplitude" in keys or "tilt" in keys)


def bessel(n, x):
    return sum((-1) ** i * (x / 2) ** (2 * i + n) / (math.factorial(i) * math.factorial(i + n)) for i in range(20))


@pytest.mark.parametrize("n", [0, 1])
def test_shapiro_steps_are_as_wide_as_bessel_functions(kapitza, tmp_path, n):
    """Kautz, Rep. Prog. Phys. 59 (1996) 935: under a fast drive step n reaches to beta n + k |J_n(a)|, a the swing's
    amplitude."""
    k, beta, amplitude = 0.02, 0.3, 1.5
    half = k * abs(bessel(n, amplitude / math.hypot(1, beta)))
    sweep = {"parameter": "torque", "min": beta * n, "max": beta * n + 1.2 * half, "count": 2,
             "measure": ["attractors"],
             "starts": 16, "velocity": {"min": n - 0.5, "max": n + 0.5}, "theta": {"min": -math.pi, "max": math.pi}}
    file = run(kapitza, tmp_path,
               {"pendulum": {"k": k, "damping": beta, "m": 0, "torque": 0, "torque_amplitude": amplitude},
                                   "numerics": {"scheme": "split6", "steps_per_period": 24}, "sweep": sweep})
    names = list(file["sweep/branch_name"].asstr()[:])
    step = names.index("rotation +1/1" if n else "down")
    assert abs((file["sweep/branch_end"][step] - beta * n) / half - 1) < 2e-3


@pytest.mark.parametrize(("m", "torque", "amplitude"), with_extensive([(0, 0, 1.2), (0, 0, 12), (0.2, 0.05, 0.4)],
                                                                      [(0, 0.13, 1.2)]))
def test_an_oscillating_torque_is_that_of_the_equation(kapitza, tmp_path, m, torque, amplitude):
    """Cycles obey theta'' + beta theta' + (k - m cos t) sin theta = torque + T cos t in the rod's own angle; k is the
    scene's."""
    k, beta = 0.3, 0.5
    scene = {"pendulum": {"k": k, "damping": beta, "m": m, "torque": torque, "torque_amplitude": amplitude},
             "attractors": {"velocity": {"min": -1, "max": 1}, "starts": 64}}
    file = run(kapitza, tmp_path, scene)
    assert (file["pendulum"].attrs["k"], file["pendulum"].attrs["torque_amplitude"]) == (k, amplitude)
    found = file["attractors"]
    x = np.array([found["strobe_theta"][0, 0], found["strobe_velocity"][0, 0]])
    end = flown(lambda t,
                y: [y[1], torque + amplitude * math.cos(t) - beta * y[1] - (k - m * math.cos(t)) * math.sin(y[0])],
                2 * math.pi * int(found["period"][0]), x, 1e-12)
    assert abs(math.remainder(end[0] - x[0], 2 * math.pi)) < 1e-9 and abs(end[1] - x[1]) < 1e-9


@pytest.mark.parametrize("name", with_extensive(["tilted"], ["square"]))
def test_saddles_manifolds_and_orbits_are_of_the_drive(kapitza, tmp_path, name):
    """Unstable cycles obey the equation, manifolds begin at them, an orbit settles on an attractor."""
    keys, force = RIGS[name]
    studies = {"saddles": {"max_period": 1, "velocity": {"min": -2, "max": 2}},
               "orbit": {"start": {"theta": 0.1, "velocity": 0}, "periods": 20}}
    file = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **studies})
    points = np.column_stack([file["saddles/strobe_theta"][:, 0], file["saddles/strobe_velocity"][:, 0]])
    assert len(points) > 0
    for point in points:
        theta, velocity = period(force, point)
        assert abs(math.remainder(theta - point[0], 2 * math.pi)) < 1e-9 and abs(velocity - point[1]) < 1e-9
    pendulum = Pendulum({"pendulum": {**PENDULUM, **keys}})
    curves = manifolds(pendulum, pendulum.saddles(), length=5)
    assert curves.sizes["point"] > 100 and np.isfinite(curves["theta"]).all()
    assert file["orbit"].attrs["settles_on"] == "down"



@pytest.mark.parametrize("keys",
                         with_extensive([{"waveform": "triangle"}], [{"drive_amplitude": 0, "torque_amplitude": 0.5}]))
def test_folding_changes_no_byte(kapitza, tmp_path, keys):
    """A window that is its own mirror image is computed by half, if the pendulum has mirror images; with a row more
    nothing is folded."""
    basin = {"method": "exact", "theta": {"count": 24}, "attractors": {"starts": 256}}
    scene = {"pendulum": {**PENDULUM, **keys}}
    folded = run(kapitza, tmp_path,
                 {**scene, "basin": {**basin, "velocity": {"min": -2, "max": 2, "count": 16}}})["basin"]
    folded = {name: folded[name][:] for name in ("attractor", "settling_time", "velocity")}
    whole = run(kapitza, tmp_path,
                {**scene, "basin": {**basin, "velocity": {"min": -2, "max": 2.25, "count": 17}}})["basin"]
    for name, values in folded.items():
        assert (whole[name][:16] == values).all(), name


OVER_TILT = {"parameter": "tilt", "min": 0, "max": 0.2, "count": 2}


@pytest.mark.parametrize("keys, study, named", [
    ({"torque": 0.1}, {"potential": {"drive_amplitudes": [0.3]}}, "pendulum.torque: study potential"),
    ({"tilt": 0}, {"basin": {**WINDOW, "method": "icm"}, "sweep": {**OVER_TILT, "measure": ["basin_fractions"]}},
     "basin.method icm"),
    ({"tilt": 0}, {"sweep": {"x": OVER_TILT, "y": {"parameter": "drive_amplitude", "min": 0.1, "max": 0.2, "count": 2},
                             "measure": ["ends"], "ends": {"theta": [1]}}}, "pendulum.tilt: sweep.measure ends"),
    ({}, {"basin": {**WINDOW, "method": "icm"}, "sweep": {**OVER_TILT, "parameter": "drive_amplitude",
                                                          "measure": ["phases"]}},
     "sweep.measure: phases"),
    ({"ramp": LINEAR}, {"attractors": {"velocity": {"min": -1, "max": 1}}}, "pendulum.ramp: needs the study basin"),
    ({"ramp": LINEAR}, {"basin": WINDOW, "orbit": {"start": {"theta": 1, "velocity": 0}}},
     "pendulum.ramp: study orbit"),
    ({"ramp": {**LINEAR, "from": -1}}, {"basin": WINDOW}, "pendulum.ramp.from"),
    ({"waveform": "samples"}, {"basin": WINDOW}, "pendulum.samples"),
    ({"samples": [1, 0, -1, 0]}, {"basin": WINDOW}, "pendulum.waveform: samples"),
    ({"ramp": {**LINEAR, "key": "k"}}, {"basin": WINDOW}, "pendulum.ramp.key"),
    ({}, {"basin": {**WINDOW, "method": "direct", "phases": 4}}, "basin.phases: needs basin.method exact"),
    ({}, {"basin": {**WINDOW, "start_phase": 1, "boundary": {}}}, "basin.start_phase: basin.boundary"),
    ({"harmonics": [{"order": 25, "amplitude": 1}]}, {"basin": WINDOW}, "pendulum.harmonics"),
    ({"vertical": [0.1]}, {"basin": WINDOW}, "pendulum.vertical: has 1 values; give a cosine and a sine"),
    ({"horizontal": [0.1, 0], "tilt": 0.1}, {"basin": WINDOW}, "leave out waveform"),
    ({"horizontal": [0.1, 0]}, {"basin": {**WINDOW, "method": "icm"}}, "pendulum.horizontal: basin.method icm"),
    ({"harmonics": [{"order": 2, "height": 1}]}, {"basin": WINDOW}, "none of order, amplitude, phase"),
])
def test_what_a_drive_does_not_allow_is_refused_by_name(kapitza, tmp_path, keys, study, named):
    assert named in refused_scene(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **study}, command="check")


FRAMED = [({"tilt": math.pi / 36}, {}), ({"harmonics": [{"order": 2, "amplitude": 0.1, "phase": 0.5}], "torque": 0.002},
                                         {}),
          ({"torque_amplitude": 0.02, "torque": 0.001}, {}),
          pytest.param({"ramp": SMOOTH}, {"start_phase": 1}, marks=pytest.mark.extensive)]


def ends(server, **keys):
    """The first strobe point of each cell's attractor in a frame; NaN where it has not settled."""
    _, ((header, planes),) = server.frame(24, 24, **keys)
    strobe = [row["strobe"][0] for row in server.catalogues[header["catalogue"]]]
    return np.array([*strobe, [np.nan, np.nan]])[np.minimum(planes["labels"], len(strobe))]


@pytest.mark.parametrize("keys, basin", FRAMED)
def test_frames_are_what_a_run_writes(kapitza, tmp_path, keys, basin):
    """Of the engine of the explorer, which takes back the keys that it gives."""
    scene = {"pendulum": {**PENDULUM, **keys},
             "basin": {**WINDOW, **basin, "method": "exact", "attractors": {"starts": 256}}}
    file = run(kapitza, tmp_path, scene)
    points = np.column_stack([file["attractors/strobe_theta"][:, 0], file["attractors/strobe_velocity"][:, 0]])
    with Server(tmp_path / "rig.yaml") as server:
        pendulum = server.pendulum
        assert keys.items() <= pendulum.items() or pendulum["ramp"].items() >= keys["ramp"].items()
        exact = ends(server, pendulum=pendulum)
        assert np.allclose(exact, points[file["basin/attractor"][:]], rtol=0, atol=1e-10)
        assert (abs(ends(server, pendulum=pendulum, quality="moving") - exact).max(axis=-1) < 1e-6).mean() > 0.95
        pendulum["drive_amplitude"] = 0.301  # as by a slider: attractors are carried there
        moving, exact = (ends(server, pendulum=pendulum, quality=quality) for quality in ("moving", "exact"))
        assert (abs(moving - exact).max(axis=-1) < 1e-6).mean() > 0.95


def test_a_laboratory_has_all_drives():
    """Through Python's Engine: a pendulum in SI units, and the same one by k, damping and m."""
    omega = 2 * math.pi * 12
    k = 9.80665 / (0.2 * omega**2)
    plain = {"k": k, "damping": math.sqrt(k) / 5, "m": 0.03 / 0.2}
    laboratory = {"length": "20 cm", "frequency": "12 Hz", "amplitude": "3 cm", "quality_factor": 5}
    drives = [{"tilt": "5 deg"}, {"ellipse": 0.2, "torque": 0.001},
              {"waveform": "samples", "samples": [1, 0.3, -1, -0.3]},
              {"harmonics": [{"order": 2, "amplitude": 0.05, "phase": "90 deg"}]}, {"ramp": LINEAR}]
    with kapitza_package.Engine({"pendulum": laboratory, "basin": {**WINDOW, "attractors": {"starts": 64}}}) as engine:
        shown = [[engine.frame(shape=(12, 16), pendulum={**form, **drive}, quality="exact")
                  for form in (laboratory, plain)]
                 for drive in drives]
    assert all((both[0] == both[1]).mean() > 0.98 for both in shown)
    assert all((one[0] != other[0]).any() for one, other in itertools.combinations(shown, 2))


def test_what_knows_the_sine_alone_is_refused_on_request(kapitza, tmp_path):
    """Deep windows at many phases; charts; an orbit that is released at a phase. A deep frame at one phase is drawn."""
    small, axis = ROOT / "scenes" / "small.yaml", {"centre": "1", "width": 1e-9}
    centred = {"theta": axis, "velocity": axis}
    options = ["--set", "basin.phases=4", "--set", 'basin.theta={centre: "1", width: 0.1, count: 4}', "--set",
               "basin.method=exact"]
    done = kapitza("check", small, *options, folder=tmp_path, status=2)
    assert "give min and max" in done.stderr
    with Server(small, "--set", "pendulum.tilt=5 deg", "--set", "basin.start_phase=1") as server:
        axes = {"x": {"parameter": "drive_amplitude", "min": 0, "max": 1, "count": 4},
                "y": {"parameter": "drive_frequency", "min": 5, "max": 6, "count": 4}}
        said = [server.ask(name, **request)[-1][0] for name, request in
                (("frame", {"rows": 8, "columns": 8, "window": centred}), ("chart", axes),
                 ("orbit", {"theta": 0, "velocity": 0}))]
        assert [header["answer"] for header in said] == ["frame", "error", "error"]
        for words, header in zip(("up and down as a sine", "begins at phase 0"), said[1:], strict=True):
            assert words in header["message"]


def test_the_pivot_moves_as_the_drive_says(kapitza, tmp_path):
    """Its acceleration is the drive, by differences: of the orbit's file and of the answer to the explorer."""
    for name in ("tilted", "square", "ellipse"):
        keys, force = RIGS[name]
        motion = {"start": {"theta": 0.1, "velocity": 0}, "periods": 1, "samples_per_period": 512}
        orbit = run(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, "orbit": motion})["orbit"]
        height, step = orbit["pivot"][:-1], 2 * math.pi / 512
        aside = orbit["pivot_aside"][:-1] if name != "square" else 0 * height
        for place, sign, part in ((height, 1, 0), (aside, -1, 1)):
            acceleration = (np.roll(place, 1) - 2 * place + np.roll(place, -1)) / step**2
            drive = [sign * force(i * step)[part] for i in range(512)]
            assert np.allclose(acceleration, drive, atol=2e-3)
        assert ("pivot_aside" in orbit) == (name != "square")
    with Server(tmp_path / "rig.yaml", "--set", "basin.velocity={min: -2, max: 2}") as server:
        (header, _), = server.ask("orbit", theta=0.1, velocity=0, periods=1, samples_per_period=512)
        assert np.allclose(header["pivot"], np.column_stack([aside, height]), atol=1e-15)


DRIVES = {"overtones": {"waveform": "square"}, "across": {"tilt": "5 deg"}}
STUDIES = {
    "icm": [{"basin": {**WINDOW, "method": "icm"}}],
    "numerics.scheme: rk4": [{"basin": {**WINDOW, "method": "direct"}, "numerics": {"scheme": "rk4"}}],
    "stability": [{"stability": {"k": {"min": 0, "max": 1, "count": 3}, "m": {"min": 0, "max": 1, "count": 3}}}],
    "orbit.model": [{"orbit": {"start": {"theta": 1, "velocity": 0}, "model": "effective"}}],
    "proof": [{"basin": {**WINDOW, **keys}} for keys in ({"proof": True}, {"boundary": {}}, {"accuracy": 0.99})],
}
RELEASED = {5: ({}, {"start_phase": 1}), 6: ({"ramp": LINEAR}, {})}  # by column


@pytest.mark.parametrize("row", STUDIES)
def test_what_the_table_of_drives_says_no_to_is_refused(kapitza, tmp_path, row):
    """docs/reference/commands.md; by the key of the drive, or of the release."""
    lines = (ROOT / "docs" / "reference"
             / "commands.md").read_text().split("### Drives")[1].split("### ")[0].splitlines()
    cells = next(line for line in lines if line.startswith("| ") and f"`{row}`" in line.split("|")[1]).split("|")
    for column, keys in enumerate(DRIVES.values(), 3):
        for study in STUDIES[row] if cells[column].strip().startswith("no") else []:
            said = refused_scene(kapitza, tmp_path, {"pendulum": {**PENDULUM, **keys}, **study}, command="check")
            assert f"pendulum.{next(iter(keys))}: " in said
    for column, (keys, released) in RELEASED.items():
        refused = cells[column].strip() == "no"
        for study in [study for study in STUDIES[row] if "basin" in study]:
            scene = {"pendulum": PENDULUM | keys, **study, "basin": study["basin"] | released}
            (tmp_path / "s.yaml").write_text(json.dumps(scene))
            done = kapitza("check", "s.yaml", folder=tmp_path, status=2 if refused else 0)
            assert not refused or ("basin.start_phase: " if released else "pendulum.ramp: ") in done.stderr
