"""Frames of the library: their parts, calls between the parts, and a stop that keeps what was found."""

import numpy as np
import pytest
from conftest import ROOT
from kapitza.live import Live, change

WINDOW = {"theta": {"min": -3, "max": 3, "count": 150}, "velocity": {"min": -2, "max": 2, "count": 110}}
OFFSET = {1: 0, 2: 1, 4: 1, 8: 5}


@pytest.fixture(scope="module")
def live():
    return Live((ROOT / "scenes" / "blackburn-fig12.yaml").read_text())


def frame(live, between=lambda: True, **keys):
    parts = []
    done = live.frame(lambda part: parts.append(part) or True, between, **{"changed": change(basin=WINDOW), **keys})
    return done, parts


def test_a_part_has_cells_of_the_frame(live):
    frame(live, moving=True)  # finds what there is: ids do not change between parts
    done, parts = frame(live, moving=True, coarseness=[8, 4, 2, 1])
    whole = parts[-1][1]["labels"]
    assert done and [header["final"] for header, _ in parts] == [False, False, False,
                                                                 True] and whole.shape == (110, 150)
    for header, planes in parts:
        step = header["level"]
        rows, columns = (np.minimum(step * np.arange(-(-count // step)) + OFFSET[step], count - 1)
                         for count in whole.shape)
        assert np.array_equal(planes["labels"], whole[np.ix_(rows, columns)])


def test_answers_within_a_frame_leave_it_as_it_is(live):
    """Starts that are asked for between its parts share its pendulum with the threads that follow its cells."""
    alone, found = [live.where([theta], ["0.3"])[0]["attractor"] for theta in ("-2", "0.1", "3")], []
    _, [(_, before)] = frame(live)

    def ask():
        found.append([live.where([theta], ["0.3"])[0]["attractor"] for theta in ("-2", "0.1", "3")])
        return True

    done, [(_, after)] = frame(live, ask, planes=("labels", "settling_time"))
    assert done and found and all(answer == alone for answer in found) and np.array_equal(before["labels"],
                                                                                          after["labels"])


def test_a_frame_that_is_stopped_keeps_what_was_found(live):
    version, asked = live.catalogue()["version"], []
    for parts, stop in ((0, lambda: False), (1, lambda: not asked)):
        asked.clear()
        done = live.frame(lambda part: asked.append(part) or True, stop, changed=change(basin=WINDOW),
                          coarseness=[8, 1])
        assert not done and len(asked) == parts
    assert live.catalogue()["version"] == version


def test_what_a_callback_raises_is_raised(live):
    with pytest.raises(ZeroDivisionError):
        frame(live, lambda: 1 / 0)
    assert frame(live)[0]


@pytest.mark.parametrize(("keys", "words"), [
    ({"coarseness": [1, 8]}, "falling order"), ({"coarseness": []}, "n_parts"),
    ({"changed": "basin: {theta: {count: 8192}, velocity: {min: -1, max: 1, count: 8192}}"},
     "more than 16777216 cells"),
    ({"changed": "pendulum: {k: 0.1, m: 0.3}"}, "pendulum.damping: is missing"),
    ({"changed": "basin: {velocity: {min: 2, max: 1}}"}, "basin.velocity.max"), ({"changed": "1"}, "change"),
    ({"atlas": "none.h5"}, "none.h5: cannot be opened")])
def test_what_is_wrong_is_refused(live, keys, words):
    with pytest.raises(ValueError, match=words):
        frame(live, **keys)
    assert frame(live)[0]
