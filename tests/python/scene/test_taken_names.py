"""Names beside the result that are links or are taken: nothing of others is written through or removed."""

import pytest
from conftest import ROOT

SMALL = ROOT / "scenes" / "small.yaml"
FEW = ["--set", "basin.theta.count=9", "--set", "basin.velocity.count=9", "--set", "basin.attractors.starts=64"]


def test_links_that_lead_nowhere(kapitza, tmp_path):
    """As the result it is there already; as the checkpoint it is refused at once."""
    (tmp_path / "small.h5").symlink_to("nowhere")
    for word in ([], ["--resume"]):
        assert "small.h5: exists" in kapitza("run", SMALL, *FEW, *word, folder=tmp_path, status=2).stderr
    kapitza("run", SMALL, *FEW, "--force", folder=tmp_path)
    assert not (tmp_path / "small.h5").is_symlink() and not (tmp_path / "nowhere").exists()
    (tmp_path / "small.h5").unlink()
    (tmp_path / "small.h5.checkpoint").symlink_to("nowhere")
    for word in ([], ["--resume"], ["--force"]):
        done = kapitza("run", SMALL, *FEW, *word, folder=tmp_path, status=2)
        assert "small.h5.checkpoint: cannot be used as checkpoint: a link" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["small.h5.checkpoint"]


def test_true_labels_are_not_written_through_a_link(kapitza, tmp_path):
    (tmp_path / "precious").write_text("mine")
    (tmp_path / "small.h5.truth.part").symlink_to("precious")
    kapitza("run", SMALL, *FEW, "--set", "tradeoff={samples: 10, settings: [direct-8]}", folder=tmp_path)
    assert (tmp_path / "precious").read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["precious", "small.h5", "small.h5.truth"]


@pytest.mark.parametrize("suffix", [".part", ".checkpoint", ".truth", ".truth.part", ""])
@pytest.mark.parametrize("what", ["a folder", "the scene itself"])
def test_names_beside_the_result_that_are_taken(kapitza, tmp_path, suffix, what):
    """Nothing is touched, with --force neither."""
    taken = tmp_path / f"x.h5{suffix}"
    if what == "a folder":
        taken.mkdir()
    else:
        taken.write_text(SMALL.read_text())
    done = kapitza("run", SMALL if what == "a folder" else taken, "-o", "x.h5", "--force", folder=tmp_path, status=2)
    assert f"{taken.name}: is {what}" in done.stderr and [path.name for path in tmp_path.iterdir()] == [taken.name]
    assert taken.is_dir() or taken.read_text() == SMALL.read_text()


@pytest.mark.parametrize("suffix", [".part", ".truth", ".truth.part"])
def test_a_file_of_somebody_else_beside_the_result_stays(kapitza, tmp_path, suffix):
    """The program's own are known by what is in them; --force overwrites."""
    taken, words = tmp_path / f"small.h5{suffix}", ["--set", "tradeoff={samples: 10, settings: [direct-8]}"]
    taken.write_text("mine")
    done = kapitza("run", SMALL, *FEW, *words, folder=tmp_path, status=2)
    assert f"{taken.name}: exists and would be overwritten" in done.stderr and taken.read_text() == "mine"
    kapitza("run", SMALL, *FEW, *words, "--force", folder=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small.h5", "small.h5.truth"]
    taken.write_bytes({".part": b"\x89HDF\r\n\x1a\n an unfinished result of kapitza"}.get(suffix,
                                                                                          b"kapitza truth 1: cut off"))
    for name in {"small.h5", "small.h5.truth"} - {taken.name}:
        (tmp_path / name).unlink()
    kapitza("run", SMALL, *FEW, *words, folder=tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small.h5", "small.h5.truth"]


def test_a_link_in_the_place_of_the_half_file_leads_nowhere(kapitza, tmp_path):
    (tmp_path / "precious").write_text("mine")
    (tmp_path / "small.h5.part").symlink_to("precious")
    kapitza("run", SMALL, *FEW, folder=tmp_path)
    assert (tmp_path / "precious").read_text() == "mine" and not (tmp_path / "small.h5").is_symlink()
