"""What the installed package must do, run by packaging/wheel/try in its folder: `try.py`, and `try.py notebook`."""

import json
import re
import subprocess
import sys
import urllib.request
from pathlib import Path

import h5py
import kapitza
import numpy as np

SCENE = "venv/share/kapitza/scenes/small.yaml"


def same(first, second):
    """Whether two files hold the same datasets, byte by byte."""
    with h5py.File(first) as a, h5py.File(second) as b:
        names = []
        a.visititems(lambda name, node: names.append(name) if isinstance(node, h5py.Dataset) else None)
        return all(content(a[name]) == content(b[name]) for name in names if name != "scene_resolved")


def content(dataset):
    """The bytes of its numbers, or its texts: an array of texts holds addresses."""
    values = np.asarray(dataset[()])
    return values.tolist() if values.dtype == object else values.tobytes()


def check_ranks():
    assert all(same("ranks-1.h5", f"ranks-{ranks}.h5") for ranks in (2, 3))
    result = kapitza.run(SCENE, ranks=2, output="package.h5", progress=False)
    assert len(result.attractors) > 0 and same("ranks-1.h5", "package.h5")


def check_zoom():
    """A window of 1e-30 about a boundary point of 34 digits has labels of both basins."""
    words = ["venv/bin/kapitza", "where", SCENE, "3.1", "0", "0.5", "0", "--boundary", "34", "--json"]
    point = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    window = {f"basin.{name}": {"centre": point[name], "width": 1e-30, "count": 16} for name in ("theta", "velocity")}
    result = kapitza.run(SCENE, set=window | {"basin.method": "exact"}, progress=False)
    assert len(np.unique(result.labels())) > 1


def check_engine():
    with kapitza.Engine(SCENE) as engine:
        assert engine.where(3.1, 0) is not None


def check_explorer():
    """`kapitza view` serves its page."""
    words = ["venv/bin/kapitza", "view", SCENE, "--no-browser"]
    view = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        address = next(found[0] for line in view.stdout if (found := re.search(r"http://\S+", line)))
        assert b"kapitza" in urllib.request.urlopen(address, timeout=20).read()
    finally:
        view.terminate()
        view.wait(20)


def check_notebook():
    import nbclient
    import nbformat

    cells = ["import kapitza", f"result = kapitza.run({SCENE!r}, output='notebook.h5', force=True, progress=False)",
             "result"]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    nbclient.NotebookClient(notebook, timeout=120).execute()
    assert "text/html" in notebook.cells[-1].outputs[0].data
    Path("notebook.ipynb").write_text(nbformat.writes(notebook))


for check in [check_notebook] if sys.argv[1:] else [check_ranks, check_zoom, check_engine, check_explorer]:
    check()
