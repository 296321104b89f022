"""Method hybrid: the labels of direct sampling from the map table, and the cells that it integrated."""

import h5py
import numpy as np
import pytest
from conftest import ROOT

SMALL = ROOT / "scenes" / "small.yaml"


def labelled(kapitza, folder, method, amplitude, ranks=None):
    name = f"{method}.h5"
    kapitza("run", SMALL, "-o", name, "--set", f"basin.method={method}", "--set", f"pendulum.drive_amplitude={amplitude}",
            "--force", ranks=ranks, folder=folder)
    with h5py.File(folder / name) as file:
        return {key: file["basin"][key][:] for key in ("attractor", "evidence", "settling_time")}


@pytest.mark.parametrize("amplitude", [0.3, 0.46])
def test_hybrid_is_as_right_as_direct(kapitza, tmp_path, amplitude):
    icm, hybrid, direct = (labelled(kapitza, tmp_path, method, amplitude) for method in ("icm", "hybrid", "direct"))
    differs = {"icm": icm["attractor"] != direct["attractor"], "hybrid": hybrid["attractor"] != direct["attractor"]}
    assert differs["hybrid"].mean() <= 0.0005
    assert amplitude < 0.4 or differs["icm"].mean() > 10 * differs["hybrid"].mean()
    again = hybrid["evidence"] == 3
    assert 0 < again.mean() < 0.6
    assert np.array_equal(hybrid["settling_time"][again], direct["settling_time"][again])
    assert not (icm["evidence"] == 3).any() and not (direct["evidence"] == 3).any()


def test_hybrid_mirrors_and_does_not_depend_on_ranks(kapitza, tmp_path):
    one = labelled(kapitza, tmp_path, "hybrid", 0.46)
    three = labelled(kapitza, tmp_path, "hybrid", 0.46, ranks=3)
    for key, values in one.items():
        assert np.array_equal(values, three[key])
    assert np.array_equal(one["evidence"], one["evidence"][::-1, ::-1])
