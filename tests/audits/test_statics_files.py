"""The same numbers in every file, and along the requested axes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from support.audits import BARS, deck_mesh, rows_of, run, tables

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize("kind", ["CPS8", "CPE4I", "Q4D", "CPS3"])
def test_every_file_tells_the_same(tmp_path: Path, kind: str) -> None:
    """U, RF, S, volumes and energies of .dat, .csv, .vtkhdf and memory are one set of numbers.

    EVOL sums to the volume t L h; ELSE sums to ALLSE; RF of .dat is reaction plus load; the sum
    of the reactions balances the load; E of .dat has half of the shear angle.
    """
    cell = {"CPS8": "quad8", "CPS3": "tri3"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell)
    text = (
        deck_mesh(mesh, kind)
        + """*MATERIAL, NAME=m
*ELASTIC
400., 0.3
*PLASTIC
3., 0.
5., 0.1
*SOLID SECTION, ELSET=all, MATERIAL=m
0.35
*BOUNDARY
left, 1, 2
*STEP, NLGEOM
*STATIC
0.25, 1., 0.1, 0.25
*CLOAD
right, 2, -0.02
right, 1, 0.1
*NODE PRINT, NSET=left, TOTALS=YES
RF
*NODE PRINT, NSET=right
U, RF
*EL PRINT, ELSET=all, TOTALS=YES
S, E, PEEQ, ELSE, EVOL
*END STEP
"""
    )
    results = run(tmp_path / "job.inp", text)
    frame = results.frames[-1]
    found = tables(tmp_path / "job.dat")
    right, left = mesh.nodes_of("right"), mesh.nodes_of("left")
    order = {label: i for i, label in enumerate(mesh.node_labels)}

    def last(head: str, rows: int) -> np.ndarray:
        return [t for t in found[head] if len(t) == rows][-1]

    u = last("displacements", len(right))
    for row in u:
        assert np.allclose(row[1:3], frame.U[order[int(row[0])]], rtol=1e-5, atol=1e-9)
    n_cells, n_points = frame.fields[0].volume.shape
    S = last("stresses", n_cells * n_points)
    E = last("strains", n_cells * n_points)
    values = frame.fields[0].values
    label = {c: k for k, c in enumerate(mesh.cells[0].labels)}
    for a, b in zip(S, E, strict=True):
        c, q = label[int(a[0])], int(a[1]) - 1
        assert np.allclose(a[[2, 3, 4, 5]], values["S"][c, q], rtol=1e-5, atol=1e-6)
        assert np.allclose(b[[2, 3, 4]], values["E"][c, q, :3], rtol=1e-5, atol=1e-8)
        assert b[5] == pytest.approx(values["E"][c, q, 3] / 2, rel=1e-5, abs=1e-8)
    volume = last("volume", n_cells)
    assert volume[:, 1].sum() == pytest.approx(4.0 * 1.0 * 0.35, rel=1e-5)
    energy = last("internal energy", n_cells)
    allse = frame.scalars["ALLSE"] + frame.scalars["ALLAE"]
    stored = ct.read_results(tmp_path / "job.vtkhdf")
    with stored:
        assert len(stored.times) == len(results.frames)
        for name in ("U1", "U2", "RF1", "RF2"):
            assert np.allclose(stored.nodal(name), results.nodal(name), rtol=1e-12, atol=1e-14)
        assert np.allclose(stored.frame().fields[0].values["S"], values["S"], rtol=1e-12)
        assert stored.history("ALLPD")[-1] == pytest.approx(frame.scalars["ALLPD"], rel=1e-12)
    import csv

    with (tmp_path / "job.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[-1]["ALLSE"]) == pytest.approx(frame.scalars["ALLSE"], rel=1e-9)
    assert float(rows[-1]["RF2 left"]) == pytest.approx(0.02 * len(right), rel=1e-8)
    moment = next(k for k in rows[-1] if k.startswith("RM3 left"))
    arm = mesh.points[left].mean(axis=0)
    x = mesh.points + frame.U - arm
    want = np.sum(
        x[left, 0] * frame.RF[left, 1] - x[left, 1] * frame.RF[left, 0] + frame.RF[left, 2]
    )
    assert float(rows[-1][moment]) == pytest.approx(want, rel=1e-8)
    applied = -np.sum(x[right, 0] * frame.F[right, 1] - x[right, 1] * frame.F[right, 0])
    assert want == pytest.approx(applied, rel=1e-6)
    assert np.isfinite(allse)
    assert energy[:, 1].sum() > 0


@pytest.mark.parametrize("kind", ["CPS8", "CPE4I", "Q4D", "OPT", "T6"])
def test_else_sums_to_the_account(tmp_path: Path, kind: str) -> None:
    """ELSE of all elements sums to ALLSE + ALLAE, elastic, with heat, NLGEOM, thickness 0.35.

    And by hand, for the linear local strain: the free part expands without energy, the held
    block has s^2/2E parts.
    """
    cell = {"CPS8": "quad8", "OPT": "tri3", "T6": "tri6"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell)
    text = (
        deck_mesh(mesh, kind)
        + """*NSET, NSET=every, ELSET=all
*MATERIAL, NAME=m
*ELASTIC
400., 0.
*EXPANSION
1e-4
*SOLID SECTION, ELSET=all, MATERIAL=m, LOCAL STRAIN=LINEAR
0.35
*BOUNDARY
left, 1, 1
right, 1, 1
left, 6, 6
right, 6, 6
1, 2, 2
*STEP, NLGEOM
*STATIC
0.25, 1., 0.1, 0.25
*TEMPERATURE
every, 50.
*EL PRINT, ELSET=all, TOTALS=ONLY
ELSE
*END STEP
"""
    )
    results = run(tmp_path / "job.inp", text)
    frame = results.frames[-1]
    V = 4.0 * 0.35
    stress = 400.0 * 1e-4 * 50.0
    # Plane strain with nu = 0: the direction across is held too.
    want = (2 if kind == "CPE4I" else 1) * stress**2 / 800.0 * V
    # The frame of a triangle turns by a second-order angle under pure stretch.
    tolerance = 5e-4 if kind in ("OPT", "T6") else 1e-5
    assert frame.scalars["ALLSE"] == pytest.approx(want, rel=tolerance)
    total = next(iter(tables(tmp_path / "job.dat").values()))[-1]
    assert float(total.ravel()[-1]) == pytest.approx(frame.scalars["ALLSE"], rel=1e-5)


def test_python_model_and_its_deck_agree(tmp_path: Path) -> None:
    """A written deck of an orthotropic, heated, loaded, turned part gives the results of Python."""
    from corota.io import formats

    mesh = ct.mesh.rectangle(5.0, 1.0, nx=5, ny=2, cell="quad8")
    model = ct.Model(mesh, name="part")
    wood = ct.Orthotropic(
        900.0, 300.0, 250.0, 0.3, 0.25, 0.2, 150.0, rho=0.1, expansion=(1e-4, 2e-4, 0.0)
    )
    model.section(
        "all",
        element="Q8R",
        material=wood,
        thickness=0.7,
        plane="strain",
        orientation=0.6,
        local_strain="logarithmic",
    )
    model.fix("left")
    model.initial_temperature(5.0)
    model.temperature(30.0)
    model.gravity(0.1, -0.5)
    model.pressure("top", 0.2)
    model.traction("right", x=0.3, y=0.1)
    model.force([int(mesh.nodes_of("right")[1])], y=0.05)
    want = ct.solve(model, ct.Static(increments=2), threads=1).frames[-1]
    path = tmp_path / "part.inp"
    formats.write(model, path)
    again = ct.read(path)
    got = ct.solve(again, None if again.steps else ct.Static(increments=2), threads=1).frames[-1]
    assert np.allclose(got.U, want.U, atol=1e-7)


def test_formats_hold_the_same_displacements(tmp_path: Path) -> None:
    """.vtkhdf, .npz, .vtu, .csv and .dat written from one result agree."""
    mesh = ct.mesh.rectangle(3.0, 1.0, nx=3, ny=1, cell="quad9")
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E=100.0, nu=0.3), thickness=2.0)
    model.fix("left")
    model.force("right", y=0.3, per_node=True)
    results = ct.solve(model, ct.Static(increments=3), threads=1)
    with ct.read_results(results.write(tmp_path / "a.vtkhdf", points=True)) as stored:
        assert np.allclose(stored.frame(2).U, results.frames[2].U, rtol=1e-14)
        assert np.allclose(stored.nodal("MISES"), results.nodal("MISES"), rtol=1e-10)
    archive = np.load(results.write(tmp_path / "a.npz"))
    want = results.frames[-1].U
    fields = [archive[k] for k in archive.files if archive[k].dtype.kind == "f"]
    shown = [f[-1][..., :2] for f in fields if f.ndim == 3 and f.shape[1] == mesh.n_nodes]
    assert any(np.allclose(f, want, rtol=1e-12) for f in shown if f.shape == want.shape)
    import csv

    with results.write(tmp_path / "a.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) in (3, 4)
    assert float(rows[-1]["ALLWK"]) == pytest.approx(results.history("ALLWK")[-1], rel=1e-9)


@pytest.mark.parametrize("label", [999999999, 12345678901, 4500000000000000000])
def test_large_numbers_of_nodes_in_every_file(tmp_path: Path, label: int) -> None:
    """A node number beyond nine digits is whole in .dat, in .csv and in the result file."""
    text = (
        BARS.replace("3, 4., 0.", f"{label}, 4., 0.")
        .replace("2, 2, 3\n", f"2, 2, {label}\n")
        .replace("3, 2, 2", f"{label}, 2, 2")
        + f"""*NSET, NSET=tip
{label}
*STEP
*STATIC
*CLOAD
{label}, 1, 2.
*NODE PRINT, NSET=tip
U
*END STEP
"""
    )
    run(tmp_path / "n.inp", text)
    row = tables(tmp_path / "n.dat")["displacements"][-1]
    lines = (tmp_path / "n.dat").read_text().splitlines()
    assert any(line.split()[:1] == [str(label)] for line in lines)
    assert row[0, 1] == pytest.approx(0.4, rel=1e-6)
    with ct.read_results(tmp_path / "n.vtkhdf") as stored:
        assert int(stored.mesh.node_labels[2]) == label


def test_invariants_of_averages_at_a_joint() -> None:
    """MISES at a node is that of the averaged components; averaged within one section, of which
    a single array has the larger by size.

    Two blocks of unlike stiffness held to a uniform strain: components known in closed form.
    """
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    model = ct.Model(mesh)
    stress = []
    for k, E in enumerate((100.0, 300.0)):
        model.section([k], element="Q4", material=ct.Elastic(E=E, nu=0.25), thickness=1.0 + k)
        C = E / (1 - 0.25**2) * np.array([[1, 0.25, 0], [0.25, 1, 0], [0, 0, 0.375]])
        stress.append(C @ [0.01, -0.002, 0.004])
    for n, (x, y) in enumerate(mesh.points):
        model.fix([n], x=0.01 * x + 0.004 * y, y=-0.002 * y)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    joint = int(np.argmin(np.hypot(mesh.points[:, 0] - 1.0, mesh.points[:, 1])))

    def mises(s: np.ndarray) -> float:
        return math.sqrt(s[0] ** 2 - s[0] * s[1] + s[1] ** 2 + 3 * s[2] ** 2)

    group = results.sections()
    for k in range(2):
        assert results.nodal("MISES", section=int(group[k]))[joint] == pytest.approx(
            mises(stress[k]), rel=1e-9
        )
    assert results.nodal("S11")[joint] == pytest.approx(stress[1][0], rel=1e-9)
    assert results.nodal("MISES")[joint] == pytest.approx(mises(stress[1]), rel=1e-9)
    e1 = 0.004 + math.hypot(0.006, 0.002)
    assert results.nodal("EP1")[joint] == pytest.approx(e1, rel=1e-6)


TURNED = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4I, ELSET=all
1, 1, 2, 3, 4
*MATERIAL, NAME=m
*ELASTIC
100., 0.3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.5
*TRANSFORM, NSET=t, TYPE=R
0.8, 0.6, 0., -0.6, 0.8, 0.
*NSET, NSET=t
2, 3
{equation}*BOUNDARY
1, 1, 2
2, 2, 2
4, 2, 2
*STEP
*STATIC
*CLOAD
3, 2, 1.
4, 1, 0.5
*NODE PRINT, NSET=nall, TOTALS=YES
U, RF
*NODE PRINT, NSET=nall, GLOBAL=YES
U, RF
*END STEP
"""


def test_dat_prints_nodes_in_their_axes(tmp_path: Path) -> None:
    """Rows of nodes with *TRANSFORM are along their axes and end with L, as CalculiX 2.20 writes.

    GLOBAL=YES gives global rows. The held direction has no displacement, the load is (0, 1).
    """
    frame = run(tmp_path / "t.inp", TURNED.format(equation="")).frames[-1]
    own, everywhere = rows_of(tmp_path / "t.dat", "displacements")[:2]
    R = np.array([[0.8, -0.6], [0.6, 0.8]])
    for node in range(4):
        first, second = own[node], everywhere[node]
        assert first.endswith(" L") is (node in (1, 2))
        assert not second.endswith("L")
        got = np.array([float(x) for x in first.split()[1:3]])
        want = frame.U[node] @ R if node in (1, 2) else frame.U[node]
        assert np.allclose(got, want, atol=1e-8)
        assert np.allclose([float(x) for x in second.split()[1:3]], frame.U[node], atol=1e-8)
    forces = rows_of(tmp_path / "t.dat", "forces")[0]
    assert np.allclose([float(x) for x in forces[2].split()[1:3]], [0.0, 1.0], atol=1e-9)
    assert abs(float(forces[1].split()[1])) < 1e-12


def test_dat_forces_hold_those_of_equations(tmp_path: Path) -> None:
    """RF of .dat is the internal force at nodes of an equation too; it sums to nothing.

    CalculiX 2.20 prints -0.0824, 1 (local) and 0.665, 0.241 at nodes 3 and 4 of this deck with its
    own element; internal forces of a body are in balance, whatever the equation adds.
    """
    text = TURNED.format(equation="*EQUATION\n2\n3, 1, 1., 4, 1, -2.\n")
    frame = run(tmp_path / "t.inp", text).frames[-1]
    rows = rows_of(tmp_path / "t.dat", "forces")[1]
    force = np.array([[float(x) for x in r.split()[1:3]] for r in rows])
    assert np.abs(force.sum(axis=0)).max() < 1e-6
    x = rows_of(tmp_path / "t.dat", "forces")[0][2].split()
    local = np.array([float(x[1]), float(x[2])])
    # The equation's force acts along local 1 of node 3 and, doubled, against x at node 4.
    assert local[1] == pytest.approx(1.0, rel=1e-6)
    assert force[3, 0] - 0.5 == pytest.approx(-2.0 * local[0], rel=1e-5)
    assert local[0] != 0.0
    assert np.allclose(frame.RF[2, :2], 0.0, atol=1e-9)


@pytest.mark.parametrize("thin", ["low", "high"])
def test_contact_area_in_dat_is_that_of_the_joint(tmp_path: Path, thin: str) -> None:
    """CF: the normal force over the area is the pressure, whichever side is the thinner."""
    from corota.model.steps import Output

    low = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    high = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=1, origin=(0.0, 1.0))
    mesh = ct.mesh.assembly(low=low, high=high)
    model = ct.Model(mesh, name="joint")
    for body in ("low", "high"):
        model.section(
            body,
            element="Q4I",
            material=ct.Elastic(E=100.0, nu=0.0),
            thickness=1.0 if body == thin else 3.0,
        )
    model.contact("high.bottom", "low.top", name="joint")
    model.fix("low.bottom")
    model.fix("high.top", y=-0.03)
    model.fix("high", x=0.0, y=None)
    step = ct.Static(nlgeom=False, outputs=[Output("contact print", ("CF",), "joint")])
    results = ct.solve(model, step, observers=[ct.JobFiles(tmp_path)], threads=1)
    numbers = [
        [float(w) for w in line.split()]
        for line in (tmp_path / "joint.dat").read_text().splitlines()
        if (line.startswith("    ") and "E+" in line) or "E-" in line
    ]
    area, normal, _ = numbers[-1]
    pressure = results.nodal("CPRESS")[mesh.nodes_of("high.bottom")]
    assert area == pytest.approx(2.0, rel=1e-6)
    assert abs(normal) / area == pytest.approx(pressure[0], rel=1e-6)
