"""Files, histories, conversions and invariances of results, and decks beside CalculiX.

Every check names its claim; its docstring says where the reference comes from.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.mesh.data import Cells
from support.audits import CELL, DRILLING, deck_mesh, ends, rotation, run
from support.pairs import cover, quickly

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


# --- A part with all at once, in other units, other numbers, other axes ---


def part(
    element: str,
    angle: float = 0.0,
    length: float = 1.0,
    force: float = 1.0,
    order: int = 0,
    plane: str = "strain",
) -> tuple[Any, Any, list[Any]]:
    """A block that flows, is heated, slides on a rigid line with friction, under its weight.

    `length` and `force` are the units in which all data are written.
    """
    stress = force / length**2
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 4, 2, CELL[element]), 0.1, seed=4)
    flat = (mesh.points[:, 1] < 0.02) & (mesh.points[:, 1] > -0.2)
    assert flat.any()
    if order:
        mesh = ct.mesh.renumber(mesh, seed=order)
    mesh = ct.mesh.move(mesh, angle=angle, scale=length)
    R = rotation(math.radians(angle))
    model = ct.Model(mesh)
    # Density such that weight is a force per volume of 0.3 at an acceleration of 3.
    steel = ct.Mises(
        E=1000.0 * stress,
        nu=0.3,
        yield_stress=3.0 * stress,
        isotropic=30.0 * stress,
        kinematic=20.0 * stress,
        rho=0.1,
        expansion=1e-4,
    )
    model.section(
        "all",
        element=element,
        material=steel,
        plane=plane,
        thickness=0.5 * length,
        local_strain="logarithmic",
    )
    ground = ct.RigidCurve.line(R @ [-3.0, 0.0] * length, R @ [5.0, 0.0] * length)
    model.contact("bottom", ground, friction=0.3, name="g")
    g = R @ [0.0, -3.0 * stress / length]
    model.gravity(x=float(g[0]), y=float(g[1]))
    model.local_axes("left", angle=math.radians(angle))
    model.fix("left", x=0.0, y=None, rotation=True if element in DRILLING else None)
    press, slide, cool = (ct.Static(increments=n) for n in (4, 4, 3))
    press.pressure("top", 3.6 * stress)
    press.temperature(20.0)
    slide.fix("left", x=0.15 * length, y=None)
    cool.temperature(-10.0)
    cool.pressure("top", 1.0 * stress)
    return model, mesh, [press, slide, cool]


@pytest.mark.parametrize(
    ("change", "element"),
    cover(["units", "angle", "numbers"], ["Q4I", "Q8R", "T6", "Q4D"], strength=1),
)
def test_contact_flow_and_heat_in_other_words(element: str, change: str) -> None:
    """Meters to millimeters, axes turned by 37 degrees, nodes renumbered: the same answer.

    Flow, friction, heat, weight, pressure and local axes in three steps; histories of energies,
    contact forces and plastic strain scale with the units, vectors turn with the axes.
    """
    # Q4D: rounding chooses whether the first attempt converges, so units that round nothing.
    thousand = 1024.0 if element == "Q4D" else 1000.0
    options: dict[str, Any] = {
        "units": {"length": thousand, "force": 2.0**-7 if element == "Q4D" else 0.01},
        "angle": {"angle": 37.0},
        "numbers": {"order": 5},
    }[change]
    frames, meshes, counts = [], [], []
    for arguments in ({}, options):
        model, mesh, steps = part(element, **arguments)
        results = ct.solve(model, steps, threads=1)
        frames.append(ends(results))
        meshes.append(mesh)
        counts.append(len(results.frames))
    # An attempt that wanders is cut where rounding takes it: other increments, another error.
    close = 2e-6 if counts[0] == counts[1] else 5e-4
    unit, force = options.get("length", 1.0), options.get("force", 1.0)
    angle = math.radians(options.get("angle", 0.0))
    R = rotation(angle)
    a, b = meshes
    x = (b.points / unit) @ R
    match = np.array([int(np.argmin(np.abs(x - p).sum(axis=1))) for p in a.points])
    assert np.allclose(x[match], a.points, atol=1e-9)
    for k, (one, two) in enumerate(zip(*frames, strict=True)):
        u = (two.U[match] / unit) @ R
        assert np.allclose(u, one.U, atol=close * np.abs(one.U).max() + 1e-9), k
        names = ("ALLSE", "ALLPD", "ALLFD", "ALLWK", "ALLTH")
        # Works are integrals over the increments: where these differ (3 beside 10 in the last
        # step at 37 degrees) so do their errors, by parts of the largest energy.
        part_of = 2e-3 * max(abs(one.scalars[name]) for name in names)
        slack = 1e-6 if counts[0] == counts[1] else part_of
        for name in names:
            want = one.scalars[name]
            assert two.scalars[name] / (unit * force) == pytest.approx(
                want, rel=100 * close, abs=slack
            )
        f = np.array([two.scalars["g: force x"], two.scalars["g: force y"]]) @ R / force
        want = [one.scalars["g: force x"], one.scalars["g: force y"]]
        assert np.allclose(f, want, rtol=5 * close, atol=1e-6)
        assert two.fields[0].values["PEEQ"].max() == pytest.approx(
            one.fields[0].values["PEEQ"].max(), rel=50 * close
        )
    assert frames[0][0].fields[0].values["PEEQ"].max() > 1e-3
    assert frames[0][-1].scalars["ALLFD"] > 0.1


# --- Files ---


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open() as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("element", quickly(["Q4I", "Q8R", "Q4D"], "Q8R"))
def test_histories_of_files_are_those_of_memory(tmp_path: Path, element: str) -> None:
    """CSV columns and result file of a part with contact, flow and heat: every increment.

    Sums of reactions, the moment about the named point, friction, energies, contact at nodes.
    """
    model, mesh, steps = part(element, angle=20.0, plane="stress")
    wanted = ["U1@right", "RF1@left", "U2@3"]
    files = ct.JobFiles(tmp_path, "job", histories=wanted, points=True)
    results = ct.solve(model, steps, observers=[files], threads=1)
    rows = rows_of(tmp_path / "job.csv")
    frames = results.frames
    assert len(rows) in (len(frames), len(frames) - 1)
    frames = frames[-len(rows) :]
    right, left = mesh.nodes_of("right"), mesh.nodes_of("left")
    moment = next(k for k in rows[0] if k.startswith("RM3 left"))
    about = np.array([float(w) for w in moment.split("(")[1].rstrip(")").split()])
    assert np.allclose(about, mesh.points[left].mean(axis=0), atol=1e-5)
    for row, f in zip(rows, frames, strict=True):
        assert float(row["U1 right"]) == pytest.approx(f.U[right, 0].mean(), rel=1e-8, abs=1e-12)
        assert float(row["RF1 left"]) == pytest.approx(f.RF[left, 0].sum(), rel=1e-7, abs=1e-9)
        third = int(np.flatnonzero(mesh.node_labels == 3)[0])
        assert float(row["U2 3"]) == pytest.approx(f.U[third, 1], rel=1e-8, abs=1e-12)
        for name in ("ALLSE", "ALLPD", "ALLFD", "ALLWK", "ALLTH", "ALLIE", "g: force y"):
            if name in f.scalars:
                assert float(row[name]) == pytest.approx(f.scalars[name], rel=1e-8, abs=1e-12)
        total = f.scalars["ALLSE"] + f.scalars["ALLPD"] + f.scalars["ALLAE"]
        assert f.scalars["ALLIE"] == pytest.approx(total, rel=1e-12)
        y = mesh.points[left] + f.U[left] - mesh.points[left].mean(axis=0)
        want = np.sum(y[:, 0] * f.RF[left, 1] - y[:, 1] * f.RF[left, 0]) + f.RF[left, 2].sum()
        assert float(row[moment]) == pytest.approx(want, rel=1e-7, abs=1e-8)
    with ct.read_results(tmp_path / "job.vtkhdf") as stored:
        assert len(stored.times) == len(results.frames)
        for k in (1, len(results.frames) // 2, -1):
            one, two = results.frames[k], stored.frame(k)
            assert np.allclose(one.U, two.U, rtol=1e-14, atol=0)
            assert np.allclose(one.C, two.C, rtol=1e-12, atol=1e-15)
            for name in ("S", "E", "PEEQ", "PE", "ALPHA", "STH", "PWORK"):
                v, w = one.fields[0].values[name], two.fields[0].values[name]
                assert np.allclose(v, w, rtol=1e-12, atol=1e-15), name
        assert np.allclose(stored.nodal("MISES", index=-1), results.nodal("MISES", -1), rtol=1e-12)


@pytest.mark.parametrize("element", quickly(["Q4I", "Q8", "T6", "OPT"], "Q8", "OPT"))
def test_free_body_of_a_part(element: str) -> None:
    """All external forces, reactions, contact forces and their moments balance about any point.

    Contact force by the scalars (force, moment on the slave about the origin), friction included.
    """
    model, mesh, steps = part(element, angle=15.0)
    for frame in ends(ct.solve(model, steps, threads=1)):
        x = mesh.points + frame.U
        force = frame.F[:, :2].sum(axis=0) + frame.RF[:, :2].sum(axis=0)
        contact = np.array([frame.scalars["g: force x"], frame.scalars["g: force y"]])
        scale = np.abs(contact).max()
        assert np.allclose(force + contact, 0.0, atol=1e-7 * scale)
        G = frame.F + frame.RF
        moment = np.sum(x[:, 0] * G[:, 1] - x[:, 1] * G[:, 0]) + G[:, 2].sum()
        assert moment + frame.scalars["g: moment"] == pytest.approx(0.0, abs=1e-6 * scale)
        # Friction and pressure parts: within the cone.
        f = np.array([frame.scalars["g: friction x"], frame.scalars["g: friction y"]])
        normal = contact - f
        assert np.linalg.norm(f) <= 0.3 * np.linalg.norm(normal) * (1 + 1e-6)


@pytest.mark.parametrize("kind", ["CPE8R", "CPS4I", "Q4D", "CPE6"])
def test_a_converted_deck_gives_the_same(tmp_path: Path, kind: str) -> None:
    """Deck to model to deck: sections, loads, amplitudes, heat and steps come back as they were.

    The second deck is written from the model that was read from the first.
    """
    cell = {"CPE8R": "quad8", "CPE6": "tri6"}.get(kind, "quad4")
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 2, cell)
    text = (
        deck_mesh(mesh, kind)
        + f"""*NSET, NSET=every, ELSET=all
*MATERIAL, NAME=m
*ELASTIC
1000., 0.3
*DENSITY
2.
*EXPANSION
1e-4
*SOLID SECTION, ELSET=all, MATERIAL=m
0.7
*INITIAL CONDITIONS, TYPE=TEMPERATURE
every, 10.
*AMPLITUDE, NAME=a
0., 0., 0.5, 1., 1., 0.4
*BOUNDARY
left, 1, 2
{"left, 6, 6" if kind == "Q4D" else "left, 1, 2"}
*STEP, NLGEOM
*STATIC
0.25, 1.
*DLOAD
1, P1, 2.
all, GRAV, 4., 0., -1., 0.
*CLOAD, AMPLITUDE=a
right, 2, 3.
*END STEP
*STEP, NLGEOM
*STATIC
0.5, 1.
*CLOAD, OP=NEW
right, 1, 1.
*TEMPERATURE
every, 60.
*END STEP
"""
    )
    (tmp_path / "one.inp").write_text(text)
    first = ct.read(tmp_path / "one.inp")
    ct.write(first, tmp_path / "two.inp")
    second = ct.read(tmp_path / "two.inp")
    a, b = (ct.solve(m, threads=1) for m in (first, second))
    assert len(a.frames) == len(b.frames)
    for one, two in zip(a.frames, b.frames, strict=True):
        assert np.allclose(one.U, two.U, rtol=1e-9, atol=1e-13)
        assert np.allclose(one.RF, two.RF, rtol=1e-7, atol=1e-9)


@pytest.fixture(scope="module")
def results() -> ct.Results:
    """The first step of the part."""
    model, _, steps = part("Q4I")
    return ct.solve(model, steps[:1], threads=1)


@pytest.mark.parametrize("format_", ["npz", "vtu", "csv", "pvd"])
def test_results_converted_by_the_command(
    results: ct.Results, tmp_path: Path, format_: str
) -> None:
    """`corota convert` of a result file: the last displacement and the energies are the same."""
    results.write(tmp_path / "job.vtkhdf")
    out = tmp_path / f"new.{format_}"
    assert main(["convert", str(tmp_path / "job.vtkhdf"), str(out)]) == 0
    assert out.stat().st_size > 0
    if format_ == "npz":
        with np.load(out) as stored:
            names = [n for n in stored.files if n.lower() in ("u", "displacement", "u1")]
            assert names, stored.files
            got = stored[names[0]]
            assert np.allclose(got[-1][..., :2] if got.ndim == 3 else got, results.frames[-1].U)
    elif format_ == "csv":
        rows = rows_of(out)
        for name in ("ALLSE", "ALLPD"):
            want = results.frames[-1].scalars[name]
            assert float(rows[-1][name]) == pytest.approx(want, rel=1e-8)


# --- Materials in Python ---


def j2(E: float, nu: float, sy: float, H: float) -> Any:
    """J2 flow with linear isotropic hardening in plane strain, tangent by the closed form."""
    G, bulk = E / (2 + 2 * nu), E / (3 - 6 * nu)

    def law(strain: Any, state: Any, plane: str) -> Any:
        if plane == "stress":  # called once, at rest, to scale the tangent
            c = E / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
            return strain @ c, np.broadcast_to(c, (*strain.shape, 3)), state
        ep, p = state[..., :4], state[..., 4]
        e = np.zeros((*strain.shape[:-1], 4))  # xx, yy, zz, xy as a tensor
        e[..., 0], e[..., 1], e[..., 3] = strain[..., 0], strain[..., 1], strain[..., 2] / 2
        ee = e - ep
        volume = ee[..., :3].sum(axis=-1)
        dev = ee.copy()
        dev[..., :3] -= volume[..., None] / 3
        s = 2 * G * dev
        norm = np.sqrt((s[..., :3] ** 2).sum(axis=-1) + 2 * s[..., 3] ** 2)
        q = np.sqrt(1.5) * norm
        dp = np.maximum(0.0, (q - sy - H * p) / (3 * G + H))
        n = s / np.maximum(norm, 1e-300)[..., None]
        flow = np.sqrt(1.5) * dp[..., None] * n
        new = np.concatenate([ep + flow, (p + dp)[..., None]], axis=-1)
        s = s - 2 * G * flow
        stress = np.stack(
            [s[..., 0] + bulk * volume, s[..., 1] + bulk * volume, s[..., 3]], axis=-1
        )
        theta = np.where(dp > 0, 1 - 3 * G * dp / np.maximum(q, 1e-300), 1.0)
        bar = np.where(dp > 0, 1 / (1 + H / (3 * G)) - (1 - theta), 0.0)
        unit = np.array([1.0, 1.0, 0.0])
        proj = np.diag([1.0, 1.0, 0.5]) - np.outer(unit, unit) / 3
        n3 = n[..., [0, 1, 3]]
        tangent = (
            bulk * np.outer(unit, unit)
            + 2 * G * theta[..., None, None] * proj
            - 2 * G * bar[..., None, None] * n3[..., :, None] * n3[..., None, :]
        )
        return stress, tangent, new, {"PEEQ": p + dp, "stress_zz": s[..., 2] + bulk * volume}

    return ct.UserMaterial(law, members=5)


@pytest.mark.parametrize(
    ("element", "strain"),
    cover(["Q4I", "Q8R", "T6", "Q4D", "Q9", "Q4S"], ["linear", "logarithmic"], strength=1),
)
def test_a_law_in_python_is_the_law_inside(element: str, strain: str) -> None:
    """J2 flow written in the test against ct.Mises: bent, turned, reversed under a force."""
    frames = []
    for law in (ct.Mises(E=500.0, nu=0.3, yield_stress=2.0, isotropic=15.0), j2(500, 0.3, 2, 15)):
        mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 4, 2, CELL[element]), 0.1, seed=8)
        end = ct.mesh.add_node(mesh, 4.0, 0.5, "end")
        model = ct.Model(mesh)
        model.section(
            "all",
            element=element,
            material=law,
            plane="strain",
            local_strain=strain,
            thickness=0.5,
        )
        model.fix("left", rotation=True if element in DRILLING else None)
        model.rigid("right", end)
        model.force([end], y=-0.03)
        turn = ct.Static(increments=16)
        turn.fix([end], x=None, y=None, rotation=-0.5)
        back = ct.Static(increments=16)
        back.fix([end], x=None, y=None, rotation=0.0)
        frames.append(ends(ct.solve(model, [turn, back], threads=1)))
    for one, two in zip(*frames, strict=True):
        assert np.allclose(one.U, two.U, atol=1e-6 * np.abs(one.U).max())
        assert np.allclose(one.RF, two.RF, atol=1e-6 * np.abs(one.RF).max())
        a, b = one.fields[0].values, two.fields[0].values
        assert np.allclose(a["PEEQ"], b["PEEQ"], atol=1e-7)
        assert np.allclose(a["S"], b["S"], atol=1e-5)
        assert a["PEEQ"].max() > 0.01


# --- Tables of .dat over steps ---


def test_tables_at_chosen_times(tmp_path: Path) -> None:
    """FREQUENCY, TIME POINTS and TOTALS over three steps: which increments are printed, and sums.

    A bar under a force that grows; U = F x/EA at the printed times, RF sums to the force.
    """
    text = """*NODE, NSET=nall
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*NSET, NSET=left
1, 4
*ELEMENT, TYPE=CPS4, ELSET=all
1, 1, 2, 3, 4
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*SOLID SECTION, ELSET=all, MATERIAL=m
1.
*TIME POINTS, NAME=tp
0.15, 0.6
*BOUNDARY
left, 1, 2
*STEP
*STATIC, DIRECT
0.1, 1.
*CLOAD
2, 1, 1.
3, 1, 1.
*NODE PRINT, NSET=left, FREQUENCY=4, TOTALS=ONLY
RF
*NODE PRINT, NSET=nall, FREQUENCY=4
U
*END STEP
*STEP
*STATIC
0.25, 1., , 0.25
*CLOAD
2, 1, 3.
3, 1, 3.
*NODE PRINT, NSET=nall, TIME POINTS=tp
U
*END STEP
*STEP
*STATIC
1., 1.
*CLOAD, OP=NEW
*END STEP
"""
    run(tmp_path / "t.inp", text)
    lines = (tmp_path / "t.dat").read_text().splitlines()
    times: dict[str, list[float]] = {"displacements": [], "total": []}
    found: dict[float, float] = {}
    sums: dict[float, float] = {}
    for i, line in enumerate(lines):
        words = line.split()
        if words[:1] == ["displacements"]:
            times["displacements"].append(float(words[-1]))
            for row in lines[i + 2 : i + 6]:
                if row.split()[0] == "2":
                    found[float(words[-1])] = float(row.split()[1])
        if words[:1] == ["total"]:
            times["total"].append(float(words[-1]))
            sums[float(words[-1])] = float(lines[i + 2].split()[0])
    assert np.allclose(times["displacements"][:3], [0.4, 0.8, 1.0])
    assert np.allclose(times["total"][:3], [0.4, 0.8, 1.0])
    # A total has its column, and the nodes of TOTALS=ONLY have none.
    heading = (tmp_path / "t.csv").read_text().splitlines()[0]
    assert "RF1 left" in heading
    assert "RF1 node 1" not in heading
    later = times["displacements"][3:]
    assert np.allclose(later[:2], [1.15, 1.6])
    assert later[-1] == pytest.approx(3.0)

    def force(t: float) -> float:
        return 2 * t if t <= 1 else 2 + 4 * (t - 1) if t <= 2 else 6 * (3 - t)

    for t, u in found.items():
        assert u == pytest.approx(force(t) * 2.0 / 100.0, rel=2e-6, abs=1e-9), t
    for t, f in sums.items():
        assert f == pytest.approx(-force(t), rel=2e-6)


@pytest.mark.parametrize("kind", ["beam", "truss"])
def test_section_forces_of_a_turned_frame(kind: str) -> None:
    """A frame with a stay turned by 50 degrees after loading: N, V, M of all members stay.

    The load turns with it (two steps of dead loads), so inner forces are those before.
    """
    points = np.array([[0.0, 0.0], [0.0, 2.0], [1.5, 2.0], [3.0, 2.0], [3.0, 0.0]])
    beams = np.array([[0, 1], [1, 2], [2, 3]])
    cells = [
        Cells("line2", beams, np.arange(1, 4)),
        Cells("line2", np.array([[4, 3]]), np.array([9])),
    ]
    if kind == "truss":
        cells = [
            Cells("line2", np.array([[0, 1], [1, 4], [1, 3], [4, 3], [0, 4]]), np.arange(1, 6))
        ]
    mesh = ct.Mesh(points, cells)
    model = ct.Model(mesh)
    steel = ct.Elastic(E=2000.0, nu=0.2)
    if kind == "beam":
        model.beam([0, 1, 2], material=steel, area=0.2, inertia=0.004, shear_area=0.1)
        model.truss([3], material=steel, area=0.01)
        hold = [0, 4]
        model.fix([0], x=None, y=None, rotation=0.0)
    else:
        model.truss([0, 1, 2, 3, 4], material=steel, area=0.05)
        hold = [0, 4]
    load, angle = np.array([1.0, -3.0]), math.radians(50.0)
    tip = 2 if kind == "beam" else 3
    if kind == "truss":
        model.fix([2])
    first = ct.Static(increments=4)
    first.force([tip], x=load[0], y=load[1])
    for n in hold:
        first.fix([n])
    turned = ct.Static(increments=10)
    R = rotation(angle)
    for n in hold:
        u = R @ points[n] - points[n]
        turned.fix([n], x=float(u[0]), y=float(u[1]))
    if kind == "beam":
        turned.fix([0], x=None, y=None, rotation=angle)
    new = R @ load
    turned.force([tip], x=float(new[0]), y=float(new[1]))
    one, two = ends(ct.solve(model, [first, turned], threads=1))
    for a, b in zip(one.fields, two.fields, strict=True):
        for name in ("N", "V", "M1", "M2"):
            if name in a.values:
                assert np.allclose(b.values[name], a.values[name], rtol=1e-6, atol=1e-8), name
    assert np.abs(one.fields[0].values["N"]).max() > 0.1
