"""The sidecar for ParaView: links to the result's own variables, and VTK reads every cell through it."""

import os
import shutil

import h5py
import numpy as np
import pytest
from conftest import plot

NAMES = ("attractor", "settling_time", "evidence")


@pytest.fixture
def pair(small_result, tmp_path):
    """A result and its sidecar, made elsewhere and moved together."""
    folder = tmp_path / "made"
    folder.mkdir()
    shutil.copy(small_result, folder / "small.h5")
    done = plot("vtkhdf", folder / "small.h5")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{folder / 'small.vtkhdf'}\n", "")
    os.rename(folder, tmp_path / "moved")
    return tmp_path / "moved" / "small.h5", tmp_path / "moved" / "small.vtkhdf"


def test_it_holds_links_and_the_window(pair):
    result, sidecar = pair
    assert sidecar.stat().st_size < 20_000 and len(list(sidecar.parent.iterdir())) == 2
    with h5py.File(sidecar) as file, h5py.File(result) as other:
        group = file["VTKHDF"]
        for name in NAMES:
            link = group["CellData"].get(name, getlink=True)
            assert (link.filename, link.path) == ("small.h5", f"/basin/{name}")
            assert np.array_equal(group["CellData"][name], other["basin"][name])
        rows, columns = other["basin/attractor"].shape
        assert group.attrs["WholeExtent"].tolist() == [0, columns, 0, rows, 0, 0]
        assert group.attrs["Origin"] == pytest.approx([-np.pi, -2, 0])
        assert group.attrs["Spacing"][:2] == pytest.approx([2 * np.pi / columns, 4 / rows])


def test_it_is_on_the_disk_before_it_has_its_name(small_result, tmp_path, monkeypatch):
    done = []
    for name, real in (("fsync", os.fsync), ("replace", os.replace)):
        monkeypatch.setattr(os, name, lambda *words, name=name, real=real: (done.append(name), real(*words)))
    assert plot("vtkhdf", small_result, "-o",
                tmp_path / "small.vtkhdf").returncode == 0 and done == ["fsync", "replace"]


def test_vtk_reads_it(pair):
    reader = pytest.importorskip("vtkmodules.vtkIOHDF", reason="no vtk: the sidecar is not read with it").vtkHDFReader()
    from vtkmodules.util.numpy_support import vtk_to_numpy
    result, sidecar = pair
    assert reader.CanReadFile(str(sidecar))
    reader.SetFileName(str(sidecar))
    reader.Update()
    image = reader.GetOutput()
    assert image.GetBounds()[:4] == pytest.approx((-np.pi, np.pi, -2, 2))
    with h5py.File(result) as file:
        for name in NAMES:
            assert np.array_equal(vtk_to_numpy(image.GetCellData().GetArray(name)), file["basin"][name][:].ravel())


@pytest.mark.parametrize(("output", "message"),
                         [("x.png", "must end in .vtkhdf"), ("small.vtkhdf", "is the result itself")])
def test_what_cannot_be_written_is_said(small_result, tmp_path, output, message):
    shutil.copy(small_result, tmp_path / "small.vtkhdf")
    before = (tmp_path / "small.vtkhdf").read_bytes()
    done = plot("vtkhdf", tmp_path / "small.vtkhdf", "-o", tmp_path / output)
    assert done.returncode in (1, 2) and message in done.stderr and (tmp_path / "small.vtkhdf").read_bytes() == before


def test_a_result_without_a_basin_is_refused(swept, tmp_path):
    done = plot("vtkhdf", swept, "-o", tmp_path / "x.vtkhdf")
    assert done.returncode == 1 and "holds no basin" in done.stderr and not list(tmp_path.iterdir())
