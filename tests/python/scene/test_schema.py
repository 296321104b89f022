"""The JSON schema of scenes: it takes every scene, and refuses what the program's own table refuses."""

import json
import re
import subprocess
import sys

import pytest
import yaml
from conftest import PROGRAM, ROOT
from jsonschema import Draft202012Validator

PENDULUM = "pendulum: {k: 0.01, damping: 0.1, m: 0.5}\n"
BASIN = "basin: {velocity: {min: -1, max: 1}}\n"


@pytest.fixture(scope="module")
def schema_text():
    return subprocess.run([PROGRAM, "keys", "--json-schema"], capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def validator(schema_text):
    schema = json.loads(schema_text)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def test_every_scene_passes_check_jsonschema(schema_text, tmp_path):
    (tmp_path / "schema.json").write_text(schema_text)
    scenes = sorted((ROOT / "scenes").glob("*.yaml"))
    command = [sys.executable, "-m", "check_jsonschema", "--schemafile", tmp_path / "schema.json", *scenes]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and len(scenes) > 40, done.stdout + done.stderr


@pytest.mark.parametrize("text", [
    BASIN,
    PENDULUM,
    PENDULUM + "basin: {}\n",
    PENDULUM + "basins: {velocity: {min: -1, max: 1}}\n",
    PENDULUM + "basin: {velocity: {min: -1, max: 1, count: 0}}\n",
    PENDULUM + "basin: {velocity: {min: -1, max: 1, count: 1.5}}\n",
    PENDULUM + "basin: {velocity: {min: -1, max: 1}, method: guess}\n",
    PENDULUM + "potential: {drive_amplitudes: []}\n",
    PENDULUM + "stability: {k: {min: 0, max: 1}, m: {min: 0, max: 1}, damping: 0.1, quality_factor: 5}\n",
    "pendulum: {k: 0.01, damping: -0.1, m: 0.5}\n" + BASIN,
    "pendulum: {k: 0.01, damping: 0.1}\n" + BASIN,
    "pendulum: {k: 0.01, damping: 0.1, m: 0.5, quality_factor: 5}\n" + BASIN,
    "pendulum: {quality_factor: 0, drive_frequency: 11, drive_amplitude: 0.3}\n" + BASIN,
    *(f"pendulum: {{k: 0.01, damping: 0.1, m: 0.5, {drive}}}\n{BASIN}" for drive in (
        "tilt: steep", "ellipse: 11", "torque: 1e7", "torque_amplitude: [1]", "waveform: cosine",
        "waveform: samples, samples: [a]",
        "ramp: {key: k, from: 1, periods: 2}", "ramp: {key: damping, from: 1}", "harmonics: [{order: 0, amplitude: 1}]",
        "harmonics: [{order: 2, height: 1}]")),
    PENDULUM + "basin: {velocity: {min: -1, max: 1}, start_phase: late}\n",
    PENDULUM + "sweep: {parameter: m, min: 0, max: 1, count: 2, measure: [phases], phases: 1}\n",
])
def test_what_the_table_refuses_the_schema_refuses(text, validator, tmp_path):
    (tmp_path / "scene.yaml").write_text(text)
    done = subprocess.run([PROGRAM, "check", tmp_path / "scene.yaml"], capture_output=True, text=True)
    assert done.returncode == 2 and not validator.is_valid(yaml.safe_load(text))


@pytest.mark.parametrize("pendulum, good", [
    ("{Q: 5, Omega: 11, epsilon: 0.3}", True), ("{quality_factor: 5, Omega: 11, drive_amplitude: 0.3}", True),
    ("{k: 0.1, beta: 0.1, m: 0.3}", True), ("{Omega: 11, drive_frequency: 11, epsilon: 0.3}", False),
    ("{Q: 5, Omega: 11}", False), ("{k: 0.1, beta: 0.1, m: 0.3, epsilon: 0.3}", False)])
def test_symbols_may_stand_for_keys(pendulum, good, validator, tmp_path):
    text = f"pendulum: {pendulum}\nsweep: {{parameter: epsilon, min: 0.1, max: 0.2, count: 2, measure: [attractors]}}\n"
    text = text if good and "k:" not in pendulum else text.replace("epsilon, min", "m, min")
    (tmp_path / "scene.yaml").write_text(text)
    done = subprocess.run([PROGRAM, "check", tmp_path / "scene.yaml"], capture_output=True, text=True)
    assert (done.returncode == 0) == validator.is_valid(yaml.safe_load(text)) == good, done.stderr


def test_the_keys_of_all_drives_are_good(validator):
    for drive in ("tilt: 5 deg, ellipse: 0.1, torque: 0.01, waveform: triangle",
                  "waveform: samples, samples: [1, 0, -1, 0]",
                  "harmonics: [{order: 2, amplitude: 0.1, phase: 90 deg}, {order: 3, amplitude: 0.1}]",
                  "ramp: {key: drive_amplitude, from: 0, periods: 2.5, shape: smooth}"):
        text = (f"pendulum: {{k: 0.01, damping: 0.1, m: 0.5, {drive}}}\nbasin: {{velocity: {{min: -1, max: 1}}, "
                f"start_phase: pi/2}}\n")
        assert validator.is_valid(yaml.safe_load(text)), drive


@pytest.mark.parametrize(("text", "good"), [("-90 deg", True), ("90 degrees", False), ("deg", False)])
def test_angles_may_be_in_degrees(text, good, validator, tmp_path):
    (tmp_path / "scene.yaml").write_text(
        PENDULUM + f"basin: {{velocity: {{min: -1, max: 1}}, theta: {{min: {text}, max: 2}}}}\n")
    done = subprocess.run([PROGRAM, "check", tmp_path / "scene.yaml"], capture_output=True, text=True)
    assert done.returncode == (0 if good else 2)
    assert validator.is_valid(yaml.safe_load((tmp_path / "scene.yaml").read_text())) == good


def test_it_knows_every_key_with_its_default(validator):
    """Against docs/reference/scene.md, which is written from the same table."""
    def keys(mapping, path=""):
        for name, item in mapping["properties"].items():
            if "properties" in item:
                yield from keys(item, f"{path}{name}.")
            else:
                yield path + name, item.get("default")

    lines = (ROOT / "docs" / "reference" / "scene.md").read_text().splitlines()
    rows = [line.strip("| \n").split(" | ") for line in lines if line.startswith("| `")]
    documented = {}
    for row in rows:
        name, *symbol = re.findall("`(.+?)`", row[0])
        if not row[1].startswith("a mapping"):
            documented |= dict.fromkeys([name, *(name.rpartition(".")[0] + "." + word for word in symbol)], row[2])
    known = dict(keys(validator.schema["allOf"][0]))
    assert known.keys() == documented.keys()
    for name, default in known.items():
        if documented[name] in ("-", "required"):
            assert default is None
        else: # PyYAML takes 1e-12 as text
            assert (type(default)(documented[name]) if isinstance(default, float)
                    else yaml.safe_load(documented[name])) == default
