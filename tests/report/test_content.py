"""What a page holds: model, course, frames; thinning tells what it leaves out."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.model.description import describe, hardening
from corota.report.chunk import unpack
from corota.report.content import Content, content_of_job, content_of_results, thinned
from corota.report.records import JobRecords, find_job, records_of_files


def beam(material: Any = None, name: str = "beam") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2), name=name)
    steel = material or ct.Mises(E=1000.0, nu=0.3, yield_stress=5.0, isotropic=50.0, name="steel")
    model.section("all", element="Q4I", material=steel, thickness=2.0)
    model.fix("left")
    model.force("right", y=-0.25)
    return model


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("job")
    with ct.JobFiles(folder) as files:
        ct.solve(beam(), ct.Static(increments=6), observers=[files], threads=1)
    return folder / "beam"


def frames_of(content: Content) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    return [unpack(data) for name, data in content.chunks.items() if name.startswith("frame-")]


def test_of_files_and_of_memory_agree(job: Path) -> None:
    results = ct.solve(beam(), ct.Static(increments=6), threads=1)
    one, other = content_of_job(find_job(job)), content_of_results(results)
    assert list(one.chunks) == list(other.chunks)
    for (head, arrays), (again, same) in zip(frames_of(one), frames_of(other), strict=True):
        assert head == again
        assert set(arrays) == set(same)
        for name in arrays:
            np.testing.assert_array_equal(arrays[name], same[name])
    header, rows = unpack(one.chunks["history"])
    again, same = unpack(other.chunks["history"])
    assert header["names"] == again["names"]
    # Memory holds no iterations; the table of the files has twelve digits.
    np.testing.assert_allclose(rows["rows"], same["rows"], rtol=1e-10, atol=1e-12)
    assert len(rows["iterations"]) > 6
    assert not len(same["iterations"])


def test_frames_hold_the_results(job: Path) -> None:
    with ct.read_results(f"{job}.vtkhdf") as results:
        content = content_of_job(find_job(job))
        last, arrays = frames_of(content)[-1]
        assert (last["kind"], last["step"], last["increment"]) == ("increment", 1, 6)
        np.testing.assert_allclose(arrays["U"], results.frame().U, rtol=4e-5)
        for column, name in enumerate(("S11", "S22", "S33", "S12")):
            wanted = results.nodal(name)
            np.testing.assert_allclose(arrays["S"][:, column], wanted, rtol=4e-5, atol=1e-6)
        np.testing.assert_allclose(arrays["PEEQ"], results.nodal("PEEQ"), rtol=4e-5, atol=1e-9)
        held = results.mesh.nodes_of("left")
        free = np.setdiff1d(np.arange(results.mesh.n_nodes), held)
        assert arrays["RF"][held].any()
        assert not arrays["RF"][free].any()


def test_model_of_a_file_is_that_of_memory(job: Path) -> None:
    described = describe(beam(), [ct.Static(increments=6)])
    with ct.read_results(f"{job}.vtkhdf") as results:
        assert results.description == json.loads(json.dumps(described))
    header, arrays = unpack(content_of_job(find_job(job)).chunks["model"])
    (section,) = header["description"]["sections"]
    assert (section["element"], section["thickness"]) == ("Q4I", 2.0)
    (support, _), (load,) = header["description"]["supports"], header["description"]["loads"]
    assert len(support["nodes"]) == 3
    assert load["kind"] == "traction"
    assert len(load["edges"]) == 2
    assert arrays["points"].shape == (33, 2)
    assert header["description"]["steps"][0]["increments"] == 6


def test_hardening_curves() -> None:
    table = ct.Mises(E=1e5, nu=0.3, yield_curve=[(200.0, 0.0), (260.0, 0.02)])
    line = np.array(hardening(table)["lines"]["isotropic"])
    np.testing.assert_allclose(np.interp([0.0, 0.01, 0.021], *line.T), [200.0, 230.0, 260.0])
    back = ct.Mises(E=1e5, nu=0.3, yield_stress=100.0, chaboche=[(3000.0, 30.0)])
    lines = {name: np.array(line) for name, line in hardening(back)["lines"].items()}
    p, stress = lines["with back-stress"].T
    np.testing.assert_allclose(stress, 100.0 + 100.0 * (1.0 - np.exp(-30.0 * p)))
    assert set(lines["isotropic"][:, 1]) == {100.0}
    # The curve is the answer of the law itself to growing uniaxial strain.
    strain = np.linspace(0.0, 0.02, 400)
    stress = back.uniaxial(strain)
    plastic = strain - stress / 1e5
    drawn = np.interp(plastic[50:], *lines["with back-stress"].T)
    np.testing.assert_allclose(stress[50:], drawn, rtol=5e-3)


def test_small_limit_thins_and_says_so(job: Path) -> None:
    whole = content_of_job(find_job(job))
    assert not whole.notes
    budget = sum(len(d) for n, d in whole.chunks.items() if n.startswith("frame-"))
    base = whole.size - budget
    limit = (250_000 + (base + 0.6 * budget) * 4.0 / 3.0) / 1e6
    thin = content_of_job(find_job(job), limit=limit)
    assert 250_000 + thin.size * 4 / 3 <= limit * 1e6 + 1000
    assert thin.notes
    frames = frames_of(thin)
    assert frames[0][0]["increment"] == 0
    assert frames[-1][0]["increment"] == 6
    assert unpack(thin.chunks["history"])[0]["left out"] == thin.notes
    # All increments are in the curves, whatever the player shows.
    assert len(unpack(thin.chunks["history"])[1]["rows"]) == 7


def test_too_small_a_limit_is_refused(job: Path) -> None:
    with pytest.raises(ct.InputError, match="raise it"):
        content_of_job(find_job(job), limit=0.251)


def test_thinned() -> None:
    assert thinned(5, 10).tolist() == [0, 1, 2, 3, 4]
    found = thinned(1000, 11)
    assert len(found) == 11
    assert (found[0], found[-1]) == (0, 999)


def test_aborted_run(tmp_path: Path) -> None:
    model = beam(ct.Mises(E=1000.0, nu=0.3, yield_stress=0.5), "collapse")
    # Arc length, which leaves no iterate, follows no amplitude.
    model.amplitudes["ramp"] = ct.Amplitude([0.0, 1.0], [0.0, 1.0])
    model.loads[0].amplitude = "ramp"
    step = ct.Static(first_increment=0.2, smallest_increment=1e-3, nlgeom=False)
    with ct.JobFiles(tmp_path) as files, pytest.raises(ct.ConvergenceError):
        ct.solve(model, step, observers=[files], threads=1)
    content = content_of_job(find_job(tmp_path / "collapse.vtkhdf"))
    header, _ = unpack(content.chunks["history"])
    assert header["end"]["status"] == "failed"
    assert header["end"]["message"]
    assert header["cut backs"]
    assert frames_of(content)[-1][0]["kind"] == "iterate"


def test_log_alone_is_enough(job: Path, tmp_path: Path) -> None:
    (tmp_path / "beam.jsonl").write_bytes(Path(f"{job}.jsonl").read_bytes())
    content = content_of_job(find_job(tmp_path / "beam"))
    assert list(content.chunks) == ["history"]
    header, arrays = unpack(content.chunks["history"])
    assert "load factor" in header["names"]
    assert len(arrays["rows"]) == 7


def test_no_such_job(tmp_path: Path) -> None:
    with pytest.raises(ct.FileError, match="no files of such a job"):
        find_job(tmp_path / "nothing.inp")


def test_modes_are_frames_of_their_own(tmp_path: Path) -> None:
    model = beam(ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    with ct.JobFiles(tmp_path) as files:
        results = ct.solve(model, ct.Frequency(modes=3), observers=[files], threads=1)
    for content in (content_of_job(find_job(tmp_path / "beam")), content_of_results(results)):
        heads = [head for head, _ in frames_of(content) if head["kind"] == "mode"]
        assert len(heads) == 3
        assert heads[0]["label"].startswith("mode 1, frequency ")


def test_a_static_step_before_a_dynamic_one(tmp_path: Path) -> None:
    model = beam(ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    steps = [ct.Static(), ct.Dynamic(period=1.0, first_increment=0.5)]
    with ct.JobFiles(tmp_path) as files:
        results = ct.solve(model, steps, observers=[files], threads=1)
    for content in (content_of_job(find_job(tmp_path / "beam")), content_of_results(results)):
        first, *_, last = frames_of(content)
        assert "VEL" not in first[1]
        np.testing.assert_allclose(last[1]["VEL"], results.frame().V, rtol=4e-5)


def test_records_grow_by_whole_lines(job: Path, tmp_path: Path) -> None:
    text = Path(f"{job}.jsonl").read_bytes()
    table = Path(f"{job}.csv").read_bytes()
    log, rows = tmp_path / "beam.jsonl", tmp_path / "beam.csv"
    reader = JobRecords(find_job_in(tmp_path))
    for share in (0.3, 0.31, 0.7, 1.0):
        log.write_bytes(text[: int(share * len(text))])
        rows.write_bytes(table[: int(share * len(table))])
        reader.update()
    whole = records_of_files(find_job(job))
    found = reader.update()
    assert found.iterations == whole.iterations
    assert np.array_equal(found.table(), whole.table(), equal_nan=True)
    assert found.end == whole.end
    # A new run of the job starts again.
    log.unlink()
    log.write_bytes(text[: text.index(b"\n") + 1])
    assert not reader.update().iterations


def find_job_in(folder: Path) -> Any:
    from corota.report.records import JobPaths

    return JobPaths(folder, "beam")


def test_units_stand_beside_names(tmp_path: Path) -> None:
    """Headings of tables with units are the names that the page asks for, and their units."""
    model = beam(name="metric")
    model.units("mm", "N", "t", "s")
    with ct.JobFiles(tmp_path, histories=["U2@right"]) as files:
        results = ct.solve(model, ct.Static(increments=2), observers=[files], threads=1)
    of_files = content_of_job(find_job(tmp_path / "metric"))
    for content in (of_files, content_of_results(results)):
        history, _ = unpack(content.chunks["history"])
        assert {"time", "ALLSE", "U2 right"} <= set(history["names"]) | {"U2 right"}
        assert not [name for name in history["names"] if "[" in name]
        units = history["units"]
        assert (units["time"], units["ALLSE"], units["energy"]) == ("s", "mJ", "mJ")
        found, _ = unpack(content.chunks["model"])
        assert found["units"]["force/length^2"] == "MPa"
        assert found["meaning"]["S11"] == "Cauchy stress xx [MPa], nodal"
    assert unpack(of_files.chunks["history"])[0]["units"]["U2 right"] == "mm"
