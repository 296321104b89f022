"""Planes that the study atlas refuses."""

import json

import pytest
from conftest import refused_scene
from test_atlas import PENDULUM, SCENE

BAD = {"one key": ({"y": {"parameter": "drive_frequency", "min": 3, "max": 30}},
     "atlas.y.parameter: is also the parameter of the other axis"),
       "a key of another form": ({"x": {"parameter": "k", "min": 0, "max": 1}}, "atlas.x.parameter: k is not given"),
       "no damping": ({"x": {"parameter": "drive_frequency", "min": 0, "max": 30}},
                      "atlas.x.min: 0 is below what pendulum"),
       "an edge that is no number": ({"x": {"parameter": "drive_frequency", "min": ".nan", "max": 30}},
                                     "atlas.x.min: \".nan\" is not a"),
       "reversed": ({"x": {"parameter": "drive_frequency", "min": 30, "max": 3}}, "atlas.x.max: 3 is too small"),
       "an edge without end": ({"y": {"parameter": "drive_amplitude", "min": 0, "max": ".inf"}},
                               "atlas.y.max: \".inf\" is not a finite"),
       "no width": ({"x": {"parameter": "drive_frequency", "min": 30, "max": 30}}, "atlas.x.max: 30 is too small"),
       "a key of no pendulum": ({"y": {"parameter": "phase", "min": 0, "max": 1}},
                                "atlas.y.parameter: \"phase\" is unknown"),
       "too strong": ({"y": {"parameter": "drive_amplitude", "min": 0, "max": 1e9}},
                      "atlas.y.max: gives abs(k) + abs(m) = 1e+09"),
       "fewer checks than none": ({"checks": -1}, "atlas.checks: \"-1\" is out of range"),
       "one place": ({"seeds": 1}, "atlas.seeds: \"1\" is out of range"),
       "no period": ({"max_period": 0}, "atlas.max_period: \"0\" is out of range; it must be an integer from 1 to 16"),
       "a frequency below 0": ({"x": {"parameter": "drive_frequency", "min": -6, "max": 14}},
                               "atlas.x.min: -6 is below what pendulum"),
       "too long": ({"max_period": 17}, "atlas.max_period: \"17\" is out of range")}


@pytest.mark.parametrize("name", BAD)
def test_bad_planes_are_refused(kapitza, tmp_path, name):
    change, message = BAD[name]
    text = json.dumps(dict(SCENE, atlas=dict(SCENE["atlas"], **change)))
    assert message in refused_scene(kapitza, tmp_path, text.replace('".nan"', ".nan").replace('".inf"', ".inf"))


def test_planes_without_damping_or_without_effect_are_refused(kapitza, tmp_path):
    undamped = {"pendulum": {"k": 0.1, "damping": 0.1, "m": 0.3},
                "atlas": {"x": {"parameter": "damping", "min": 0, "max": 1},
                                                                         "y": {"parameter": "m", "min": 0, "max": 1}}}
    idle = {"pendulum": dict(PENDULUM, ramp={"key": "damping", "from": 0.1, "periods": 4}),
            "basin": {"theta": {"count": 8}, "velocity": {"min": -1, "max": 1, "count": 8}},
            "atlas": {"x": {"parameter": "ramp.periods", "min": 1, "max": 4},
                      "y": {"parameter": "drive_amplitude", "min": 0, "max": 1}}}
    for scene, message in ((undamped, "no damped pendulum at damping = 0"),
                           (idle, "\"ramp.periods\" is unknown; it must be one of")):
        assert message in refused_scene(kapitza, tmp_path, scene)
