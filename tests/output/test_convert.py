"""`corota convert` among all formats of results: what both can hold arrives."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.io.result_reader import RESULT_READERS
from corota.io.writers import STREAMS, WRITERS
from support.pairs import cover

EXACT = {".vtkhdf": 0.0, ".pvd": 0.0, ".vtu": 0.0, ".frd": 1e-5}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One job in every format."""
    path = tmp_path_factory.mktemp("job")
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1), name="job")
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=2.0, isotropic=50.0)
    model.section("all", element="Q4I", material=steel, local_strain="logarithmic")
    model.contact("top", ct.RigidCurve.line((6.0, 1.2), (0.0, 1.2)))
    model.fix("left")
    model.fix("right", x=None, y=0.3)
    results = ct.solve(model, ct.Static(increments=3), threads=1)
    for ending in EXACT:
        results.write(path / f"job{ending}")
    return path


@pytest.mark.parametrize(
    ("target", "source"), cover(list(EXACT), list(EXACT), strength=1, allowed=lambda a, b: a != b)
)
def test_fields_arrive(folder: Path, tmp_path: Path, source: str, target: str) -> None:
    out = tmp_path / f"out{target}"
    assert main(["convert", str(folder / f"job{source}"), str(out), "-q"]) == 0
    with ct.read_results(folder / "job.vtkhdf") as wanted, ct.read_results(out) as found:
        n = wanted.mesh.n_nodes
        scale = max(EXACT[source], EXACT[target])
        for name in ("U1", "U2", "S11", "S12", "E12", "MISES", "SP1", "PEEQ", "ENER", "CPRESS"):
            a, b = wanted.nodal(name), found.nodal(name)[:n]
            assert b == pytest.approx(a, rel=scale, abs=20 * scale * np.abs(a).max()), name
        if ".frd" not in (source, target):
            assert np.array_equal(found.cells("S11"), wanted.cells("S11"))
            assert np.array_equal(found.nodal("RF2"), wanted.nodal("RF2"))
        if ".vtu" not in (source, target):
            count = len(wanted.frames) - (".frd" in (source, target))
            assert len(found.frames) == count
            assert found.times == pytest.approx(wanted.times[-count:], rel=1e-5)


@pytest.mark.parametrize("source", list(EXACT))
def test_histories_become_csv(folder: Path, tmp_path: Path, source: str) -> None:
    out = tmp_path / "out.csv"
    assert main(["convert", str(folder / f"job{source}"), str(out), "-q"]) == 0
    lines = out.read_text().splitlines()
    assert "largest U" in lines[0]
    assert "nan" not in out.read_text()


def test_every_reader_has_a_writer() -> None:
    assert set(RESULT_READERS) <= set(WRITERS)
    assert {f".{name.partition('-')[0]}" for name in STREAMS} <= set(RESULT_READERS)


@pytest.mark.parametrize("ending", [".pvd", ".vtu", ".frd"])
def test_files_of_others_are_refused_by_name(tmp_path: Path, ending: str) -> None:
    (tmp_path / f"a{ending}").write_text("<VTKFile/>")
    with pytest.raises(ct.FileError, match=rf"a\{ending}"):
        ct.read_results(tmp_path / f"a{ending}")
