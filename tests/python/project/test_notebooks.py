"""The notebooks of docs/notebooks: each runs from top to bottom in a kernel of its own, on small grids."""

import pytest
from conftest import ROOT

jupytext = pytest.importorskip("jupytext")
nbclient = pytest.importorskip("nbclient")
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.py"))


@pytest.mark.extensive
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    monkeypatch.setenv("KAPITZA_NOTEBOOK_COUNT", "16")
    notebook = jupytext.read(path)
    nbclient.NotebookClient(notebook, timeout=None, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert len(outputs) >= 3 and not [output for output in outputs if output.output_type == "error"]


def test_there_are_five_notebooks():
    assert [path.name[0] for path in NOTEBOOKS] == list("12345")
