"""Scheme and steps: what auto takes, what it says of them, what stays the same."""

from conftest import ROOT, datasets, run_scene

SMALL = ROOT / "scenes" / "small.yaml"
TINY = ["--set", "basin.theta.count=60", "--set", "basin.velocity.count=60", "--set", "basin.attractors.starts=1024"]
DIRECT = [*TINY, "--set", "basin.method=direct"]


def test_the_default_is_processed_and_reruns_from_its_resolved_scene(kapitza, tmp_path):
    result, said = run_scene(kapitza, tmp_path, SMALL, *DIRECT)
    held, resolved = result.group("basin").attrs, result.attributes["scene_resolved"]
    assert held["scheme"] == "processed" and held["tolerance"] == 1e-12 and 0 < held["step_error"] < 2e-12
    assert f"processed splitting, {held['steps_per_period']} steps per drive period" in said
    assert "steps_per_period: auto" in resolved
    assert datasets(run_scene(kapitza, tmp_path, resolved, name="again")[0].path) == datasets(result.path)


def test_a_looser_tolerance_takes_fewer_steps(kapitza, tmp_path):
    fine, loose = (run_scene(kapitza, tmp_path, SMALL, *DIRECT, "--set",
                             f"numerics.tolerance={tolerance}")[0].group("basin").attrs
                   for tolerance in (1e-12, 1e-6))
    assert loose["steps_per_period"] < fine["steps_per_period"] and 1e-9 < loose["step_error"] < 2e-6
