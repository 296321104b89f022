"""What the explorer computes in the background and keeps, and the stories that it tells."""

import os
import time
from argparse import ArgumentTypeError

import numpy as np
import pytest
import yaml
from conftest import PROGRAM, ROOT
from kapitza.explorer import atlas, overlays, stories
from kapitza.explorer.process import Refused
from kapitza.explorer.requests import BadRequest
from kapitza.explorer.run_cache import RunCache
from kapitza.explorer.scene import Start
from kapitza.plots.page_options import colours_of
from kapitza.result import BadFile
from kapitza.scene import tree_of
from PIL import Image
from PIL.PngImagePlugin import PngInfo

PENDULUM = {"quality_factor": 5, "drive_frequency": 11, "drive_amplitude": 0.3}
PLANE = {"x": {"parameter": "drive_frequency", "min": 8, "max": 14},
         "y": {"parameter": "drive_amplitude", "min": 0, "max": 0.6}}


@pytest.fixture
def kept(tmp_path):
    return RunCache(PROGRAM, folder=tmp_path)


def test_a_map_is_computed_once_and_has_the_limits_of_rest(kept, monkeypatch):
    monkeypatch.setattr(atlas, "STAGES", ({"max_period": 1, "checks": 0, "points": 24},))
    first = list(atlas.maps(kept, {"pendulum": PENDULUM, **PLANE}))
    assert [header["answer"] for header, _ in first[:-1]] == ["progress"] * (len(first) - 1) and len(first) > 1
    again = list(atlas.maps(kept, {"pendulum": PENDULUM, **PLANE}))
    assert again == first[-1:] and again[0][0]["final"]
    header, payload = again[0]
    assert len(payload) == header["bytes"] == 17 * header["points"] + 2 * header["cells"] ** 2
    x, y = np.frombuffer(payload, "<f4", 2 * header["points"]).reshape(2, -1)
    limits = {curve["kind"]: np.interp(0.5, *sorted_by_x(x, y, curve)) * 0.6 for curve in header["curves"]
              if curve["name"] == "inverted"}
    assert limits["rest_leans"] == pytest.approx(0.129,
                                                 abs=1e-3) and limits["rest_swings"] == pytest.approx(0.468, abs=1e-3)


def sorted_by_x(x, y, curve):
    part = slice(curve["first"], curve["first"] + curve["points"])
    order = np.argsort(x[part])
    return x[part][order], y[part][order]


def test_a_damaged_result_is_computed_again_and_what_killed_explorers_left_goes(kept, monkeypatch, tmp_path):
    """The map of that pendulum was an error for ever."""
    monkeypatch.setattr(atlas, "STAGES", ({"max_period": 1, "checks": 0, "points": 24},))
    first = list(atlas.maps(kept, {"pendulum": PENDULUM, **PLANE}))[-1]
    (path,) = tmp_path.glob("*.h5")
    whole = path.read_bytes()
    for name, age in (("tmpold", 7200), ("tmpnew", 0)):
        (tmp_path / name).mkdir()
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    for damaged in (b"", whole[:len(whole) // 2], whole[:3000] + bytes(3000) + whole[6000:]):
        path.write_bytes(damaged)
        assert list(atlas.maps(kept, {"pendulum": PENDULUM, **PLANE}))[-1] == first
        assert len(path.read_bytes()) == len(whole)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted([path.name, "tmpnew"])


def test_what_cannot_be_computed_is_refused_in_the_programs_words(kept):
    with pytest.raises(Refused, match="damping"):
        list(atlas.maps(kept, {"pendulum": {"k": 0.1, "damping": 0, "m": 0.3},
                               "x": {"parameter": "k", "min": 0, "max": 1},
                               "y": {"parameter": "m", "min": 0, "max": 1}}))
    with pytest.raises(BadRequest, match="max_period"):
        list(atlas.maps(kept, {"pendulum": PENDULUM, **PLANE, "max_period": 0}))
    with pytest.raises(BadRequest, match="pendulum, x and y"):
        list(atlas.maps(kept, {"pendulum": PENDULUM}))
    with pytest.raises(BadRequest, match="fastest"):
        overlays.skeleton(kept, {"pendulum": PENDULUM, "fastest": -1})


def test_a_boundary_has_saddles_and_lines(kept, monkeypatch):
    monkeypatch.setattr(overlays, "LENGTH", 0.5)
    header, _ = list(overlays.skeleton(kept, {"pendulum": PENDULUM, "fastest": 2}))[-1]
    assert header["final"] and header["overlays"]["saddles"]["points"] and header["overlays"]["manifolds"]["lines"]


def test_the_stories_that_come_with_the_page_can_be_told():
    told = stories.written(ROOT / "web" / "explorer" / "stories")
    assert len(told) == 7 and all(len(story["steps"]) > 3 for story in told)
    assert told[-1]["pivot_frequency"] == pytest.approx(100 * np.pi) and told[1]["pivot_frequency"] is None


@pytest.mark.parametrize(("change", "words"), [
    ("title: [", "mine.yaml:2: is not YAML"), ("steps: [{view: trace}]", "mine.yaml: step 1: say: is missing"),
    ("steps: [{say: a, view: side}]", "step 1: view: side is unknown"),
    ("steps: [{say: a, start: {theta: 1}}]", "step 1: start"),
    ("steps: [{say: a, pendulum: {m: 1}}]", r"step 1: pendulum.m: the story's own"),
    ("steps: [{say: a, map: on}]", "map: True is not"),
    ("color: red", "color: unknown key; known are title"), ("steps: all", "steps: all is not"),
    ("steps: [{say: a, glide: .inf}]", "step 1: glide: inf is not"),
    ("pendulum: {k: 2020-02-02}", "mine.yaml: pendulum: {'k': datetime"),
    ("window: {theta: {min: }}", "window: {'theta': {'min': None}} is not")])
def test_a_story_that_is_wrong_is_refused_with_its_place(change, words):
    right = {"title": "a", "pendulum": {"k": 0.1}, "steps": [{"say": "a"}]}
    text = change + "\n" if "[" in change and change.endswith("[") else yaml.safe_dump(right | yaml.safe_load(change))
    with pytest.raises(BadRequest, match=words):
        stories.read(text, "mine.yaml")


@pytest.mark.parametrize(("value", "words"), [
    ("&a [1]", "mine.yaml:2: .* an anchor"), ("*a", "mine.yaml:2: .* an alias"), ("!!float 1", "mine.yaml:2: .* a tag"),
    ("2020-99-99", "mine.yaml: .* month"), ("9" * 5000, "mine.yaml: .* limit"),
    (f"0x{'f' * 6000}", "pendulum: a number of thousands"), ("[" * 5000, "mine.yaml: .* too deeply")])
def test_a_story_is_refused_before_anything_in_it_is_expanded(value, words):
    """Aliases ten wide and six deep made gigabytes of 500 bytes."""
    with pytest.raises(BadRequest, match=words):
        stories.read(f"title: a\npendulum: {{k: {value}}}\nsteps: [{{say: a}}]\n", "mine.yaml")


def test_aliases_of_a_scene_are_left_to_the_program_which_refuses_them(tmp_path):
    """The page, plots and messages read scenes too, of files that others made."""
    laughs = "a0: &a0 [x]\n" + "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 7))
    text = f"{laughs}pendulum: {{k: *a6}}\n"
    (tmp_path / "laughs.yaml").write_text(text)
    assert tree_of(text) == {} and Start(tmp_path / "laughs.yaml").tree == {}
    assert Start("pendulum: {k: 1}\n", is_text=True,
                 sets=[f"pendulum.m=[{'&a x, ' * 3}]"]).tree == {"pendulum": {"k": "1"}}
    with pytest.raises(ArgumentTypeError, match="cannot be read: an anchor"):
        colours_of(str(tmp_path / "laughs.yaml"))


def test_a_picture_is_opened_by_the_scene_that_it_holds(tmp_path):
    def saved(keyword):
        texts = PngInfo()
        texts.add_itxt(keyword, "title: größer\npendulum: {k: 0.1}\n")
        Image.new("RGB", (2, 2)).save(tmp_path / "view.png", pnginfo=texts)
        return tmp_path / "view.png"

    assert Start(saved("kapitza scene")).tree == {"title": "größer", "pendulum": {"k": "0.1"}}
    with pytest.raises(BadFile, match="holds no scene"):
        Start(saved("Comment"))
    saved("kapitza scene").write_bytes(saved("kapitza scene").read_bytes()[:60])
    with pytest.raises(BadFile, match="damaged"):
        Start(tmp_path / "view.png")
