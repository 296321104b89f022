"""The tutorial runs as it stands, and its answer is that of an independent run."""

import math
import re
import subprocess
import sys

from conftest import ROOT
from kapitza.result import Result


def test_the_answer_of_the_tutorial(kapitza, tmp_path):
    script = ROOT / "docs" / "tutorials" / "how-hard.py"
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode,
            done.stderr) == (0, "") and sorted(path.name for path in tmp_path.iterdir()) == ["push.h5", "push.yaml"]
    low, high = map(float, re.search(r"stands a push of (0\.\d+) .* at (0\.\d+) it ends", done.stdout).groups())
    assert 0 < high - low < 1e-8 and "(decided)" in done.stdout
    step = high - low
    theta = f"{{min: {math.pi - 1e-9!r}, max: {math.pi + 1e-9!r}, count: 1}}"
    velocity = f"{{min: {low - step / 2!r}, max: {high + step / 2!r}, count: 2}}"
    kapitza("run", "push.yaml", "--set", f"basin.theta={theta}", "--set", f"basin.velocity={velocity}", "--set",
            "basin.method=direct", "-o", "edge.h5", folder=tmp_path)
    edge = Result(tmp_path / "edge.h5")
    names = edge.group("attractors")["name"].values
    stands, falls = (str(names[index]) for index in edge.group("basin")["attractor"].values[:, 0])
    assert stands == "inverted" and falls != "inverted" and f'it ends on "{falls}"' in done.stdout
