"""How large the amplitude must be: the command needs, kapitza.needs, and the page of amplitudes."""

import importlib.util
import json
import math
import subprocess

import kapitza
import pytest
from conftest import PROGRAM, ROOT

GRAVITY = 9.80665


def ask(*words):
    return subprocess.run([PROGRAM, "needs", *words], capture_output=True, text=True)


def test_the_slow_equation_gives_the_smallest_amplitude_of_a_fast_pivot():
    found = kapitza.needs("20 cm", "400 Hz", 100)
    low, high = found["stands"]
    assert low == pytest.approx(math.sqrt(2 * GRAVITY * 0.2) / (2 * math.pi * 400), rel=1e-4)
    assert high == pytest.approx(0.2 * 0.45396, rel=1e-3)  # Mathieu's equation without gravity: q = 0.90805
    assert found["flutters"][0] == pytest.approx(high, rel=1e-6) and found["flutters"][1] > high
    assert found["stands_g"][0] == pytest.approx(low * (2 * math.pi * 400) ** 2 / GRAVITY)


@pytest.mark.parametrize(("hertz", "quality"), [("50", "3"), ("50", "200"), ("400", "100"), ("400", "200"),
                                                ("400", "1e6")])
def test_flutter_ends_where_its_period_doubles_whatever_the_damping(hertz, quality):
    """Weak damping: a walk jumped to another cycle at m = 2; rounding stopped Newton's method where flutter begins."""
    found = json.loads(ask("--length", "1", "--frequency", hertz, "--quality-factor", quality, "--json").stdout)
    assert found["flutters"][1] == pytest.approx(0.562, abs=2e-3)


@pytest.mark.parametrize(("words", "said"), [
    (["--length", "20 cm"], "needs: --frequency is missing"),
    (["--length", "200", "--frequency", "50"],
     "--length: 200 is taken for 200 m, more than a laboratory has; give its unit"),
    (["--length", "20", "kg", "--frequency", "50"], '--length: "20 kg" is in a unit of another quantity'),
    (["--length", "-1", "--frequency", "50"], '--length: "-1" is out of range; it must be a number above 0 in m'),
    (["--length", "0.2", "--frequency", "1"],
     "--frequency: 1 Hz is not above that of the pendulum's own swings, 1.114 Hz"),
    (["--length", "0.2", "--frequency", "50", "--quality-factor", "0"], '--quality-factor: "0" is out of range')])
def test_needs_refuses_wrong_words_in_one_line(words, said):
    done = ask(*words)
    assert (done.returncode, done.stdout) == (2, "") and done.stderr.startswith(f"kapitza: error: {said}")
    assert done.stderr.count("\n") == 1


def test_the_page_of_amplitudes_holds_what_the_program_says():
    spec = importlib.util.spec_from_file_location("amplitudes", ROOT / "docs" / "amplitudes.py")
    amplitudes = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(amplitudes)
    lines = amplitudes.PAGE.read_text().splitlines()
    for hertz, place in ((10, 0), (50, 3), (120, 5)):
        cells = next(line for line in lines if line.startswith(f"| {hertz} Hz")).strip("| ").split(" | ")
        assert len(cells) == 1 + len(amplitudes.LENGTHS)
        assert cells[1 + place] == f"{amplitudes.smallest(amplitudes.LENGTHS[place], hertz):.3g}"
    assert [name for name in amplitudes.SHAKERS if not any(line.startswith(f"| {name} |") for line in lines)] == []
