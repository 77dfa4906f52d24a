"""Joints of compliant mechanisms beside published formulas.

    python joints.py            # all: a table of ours and the formula
    python joints.py notch      # one; with --plot also its picture

Each joint is one function; change its numbers for a joint of your own.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np

import corota as ct

#: Name of a value, ours, that of the formula.
Row = tuple[str, float, float]


def frame(*lines: np.ndarray, stages: dict[str, tuple[float, float]]) -> tuple[ct.Model, list]:
    """A model of beams along lines of points, with a node for each stage.

    Returns
    -------
    model : Model
    ends : list of (int, int)
        First and last node of each line.
    """
    first, points, ends = 0, [], []
    cells = []
    for line in lines:
        count = len(line)
        cells.append(np.column_stack([np.arange(count - 1), np.arange(1, count)]) + first)
        ends.append((first, first + count - 1))
        points.append(line)
        first += count
    table = np.concatenate(cells)
    mesh = ct.Mesh(np.concatenate(points), [ct.Cells("line2", table, np.arange(1, len(table) + 1))])
    for name, place in stages.items():
        ct.mesh.add_node(mesh, *place, name)
    return ct.Model(mesh), ends


def straight(start, end, n: int = 20) -> np.ndarray:
    """Points of a straight leaf."""
    return np.linspace(start, end, n + 1)


def leaves(model: ct.Model, thickness: float, young: float = 1.0e5, **more) -> float:
    """Make all lines leaves of unit depth; return E I."""
    inertia = thickness**3 / 12.0
    material = ct.Elastic(E=young, nu=0.0, **more)
    model.beam(np.arange(model.mesh.n_cells), material=material, area=thickness, inertia=inertia)
    return young * inertia


def leaf() -> tuple[ct.Results, list[Row]]:
    """A leaf with a dead force across its end: F L^2 / E I = 1 and 3.

    Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272: 0.30172 and 0.60325 L.
    """
    model, ((clamp, tip),) = frame(straight((0, 0), (100, 0), 40), stages={})
    bending = leaves(model, 0.5)
    model.fix([clamp], rotation=True)
    model.force([tip], y=3.0 * bending / 100.0**2)
    model.stage("tip", [tip], axis="y")
    results = ct.solve(model, ct.Static(increments=6), threads=1)
    travel = results.history("travel").values / 100.0
    start = results.history("axis stiffness")[0]
    return results, [
        ("3 E I / L^3 at the start", start, 3 * bending / 1e6),
        ("travel / L at F L^2/EI = 1", travel[2], 0.30172),
        ("travel / L at F L^2/EI = 3", travel[-1], 0.60325),
    ]


def cross() -> tuple[ct.Results, list[Row]]:
    """Two leaves at 90 degrees that cross at half length, under a moment.

    Exact elastica by shooting; 2 E I / L at the start (Haringx, Appl. Sci. Res. A1 (1949) 313).
    """
    half = 50.0 / np.sqrt(2.0)
    model, ends = frame(
        straight((-half, -half), (half, half), 40),
        straight((half, -half), (-half, half), 40),
        stages={"hub": (0.0, 0.0)},
    )
    bending = leaves(model, 0.2)
    hub = model.mesh.nodes_of("hub")[0]
    model.fix([end[0] for end in ends], rotation=True)
    model.rigid([end[1] for end in ends], int(hub))
    model.force([hub], moment=1.501060 * bending / 100.0)
    model.stage("hub", axis="rotation")
    times = [0.350829, 0.712016, 1.092898, 1.501060]
    model.amplitudes["steps"] = ct.Amplitude([0, 1, 2, 3, 4], [0, *np.array(times) / times[-1]])
    model.loads[-1].amplitude = "steps"
    results = ct.solve(model, ct.Static(increments=8, period=4.0), threads=1)
    angle = np.degrees(results.history("rotation").values[2::2])
    x, y = (results.history(f"motion {a}").values[2::2] / 100.0 for a in "xy")
    rows = [(f"rotation [degrees] at M L/EI = {m}", a, w)
            for m, a, w in zip(times, angle, (10.0, 20.0, 30.0, 40.0), strict=True)]  # fmt: skip
    return results, [
        ("2 E I / L at the start", results.history("axis stiffness")[0], 2 * bending / 100.0),
        *rows,
        ("shift x / L at 20 degrees", x[1], -2.466104e-3),
        ("shift y / L at 20 degrees", y[1], 1.398597e-2),
        ("shift x / L at 40 degrees", x[3], -1.881520e-2),
        ("shift y / L at 40 degrees", y[3], 5.169433e-2),
    ]


def notch() -> tuple[ct.Results, list[Row]]:
    """A circular notch hinge, radius 5, neck 1, under a moment.

    Integral of 12 / (E b h^3) along the neck (Wu and Zhou, Rev. Sci. Instrum. 73 (2002) 3101), and
    its limit for thin necks 2 E b t^(5/2) / (9 pi R^(1/2)) (Paros and Weisbord, Machine Design 37
    (1965) 151). Both take plane sections; the body has shear and stress raised at the notch.
    """
    radius, neck, height = 5.0, 1.0, 11.0
    n = 24
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * n + 1)
    x = radius * np.sin(angle)
    half = 0.5 * neck + radius * (1.0 - np.cos(angle))
    outer = np.linspace(radius, 2.0 * radius, 6)[1:]
    x = np.concatenate([-outer[::-1], x, outer])
    half = np.concatenate([np.full(5, 0.5 * height), half, np.full(5, 0.5 * height)])

    mesh = _strip(x, half, 12)
    model = ct.Model(mesh)
    young = 2.0e5
    model.section("all", element="Q4D", material=ct.Elastic(E=young, nu=0.3))
    model.fix("left")
    model.force("right", moment=0.5)
    model.stage("right", axis="rotation", allowable={"MISES": 100.0}, point=(0.0, 0.0))
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 4001)
    h = neck + 2.0 * radius * (1.0 - np.cos(turn))
    integral = np.trapezoid(12.0 * radius * np.cos(turn) / (young * h**3), turn)
    paros = 2.0 * young * neck**2.5 / (9.0 * np.pi * radius**0.5)
    found = float(results.history("axis stiffness")[0])
    return results, [
        ("stiffness, integral of the neck", found, 1.0 / integral),
        ("stiffness, thin neck", found, paros),
    ]


def _strip(x: np.ndarray, half: np.ndarray, ny: int) -> ct.Mesh:
    """A symmetric strip of half height `half` at the stations x."""
    mesh = ct.mesh.rectangle(1.0, 2.0, nx=len(x) - 1, ny=ny, origin=(0.0, -1.0))
    column = np.rint(mesh.points[:, 0] * (len(x) - 1)).astype(int)
    mesh.points[:] = np.column_stack([x[column], half[column] * mesh.points[:, 1]])
    return mesh


def parallelogram() -> tuple[ct.Results, list[Row]]:
    """Two leaves of length L that carry a rigid stage.

    Stiffness 24 E I / L^3, parasitic translation -3/5 d^2 / L: Awtar, Slocum and Sevincer, J. Mech.
    Des. 129 (2007) 625, for small d / L; a force at half the length of the leaves does not turn it.
    """
    model, ends = frame(
        straight((0, 0), (0, 100)), straight((60, 0), (60, 100)), stages={"stage": (30.0, 50.0)}
    )
    bending = leaves(model, 0.5)
    stage = int(model.mesh.nodes_of("stage")[0])
    model.fix([end[0] for end in ends], rotation=True)
    model.rigid([end[1] for end in ends], stage)
    model.force([stage], x=24.0 * bending / 1e6 * 10.0)
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    travel = float(results.history("travel")[1])
    return results, [
        ("24 E I / L^3 at the start", results.history("axis stiffness")[0], 24 * bending / 1e6),
        ("parasitic translation L / d^2 at d = L / 50",
         results.history("parasitic translation")[1] * 100.0 / travel**2, -0.6),
        ("lateral stiffness 2 E A / L", results.history("lateral stiffness")[0],
         2 * 1e5 * 0.5 / 100),
    ]  # fmt: skip


def double_parallelogram() -> tuple[ct.Results, list[Row]]:
    """Two parallelograms in series: the parasitic translations cancel.

    Stiffness 12 E I / L^3 (half of one): Awtar, Slocum and Sevincer (2007). Half of a folded beam
    of a comb drive, which has twice the stiffness, 24 E I / L^3 (Legtenberg, Groeneveld and
    Elwenspoek, J. Micromech. Microeng. 6 (1996) 320).
    """
    lines = [straight((x, 0), (x, 100)) for x in (0.0, 20.0, 60.0, 80.0)]
    model, ends = frame(*lines, stages={"middle": (40.0, 100.0), "stage": (40.0, 50.0)})
    bending = leaves(model, 0.5)
    middle, stage = (int(model.mesh.nodes_of(n)[0]) for n in ("middle", "stage"))
    model.fix([ends[0][0], ends[3][0]], rotation=True)
    model.rigid([end[1] for end in ends], middle)
    model.rigid([ends[1][0], ends[2][0]], stage)
    model.force([stage], x=12.0 * bending / 1e6 * 10.0)
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    return results, [
        ("12 E I / L^3 at the start", results.history("axis stiffness")[0], 12 * bending / 1e6),
        ("parasitic translation / travel at d = L / 10",
         results.history("parasitic translation")[-1] / results.history("travel")[-1], 0.0),
    ]  # fmt: skip


def folded() -> tuple[ct.Results, list[Row]]:
    """The folded beam of a comb drive: two double parallelograms carry the shuttle.

    Eight leaves, 24 E I / L^3: Legtenberg, Groeneveld and Elwenspoek, J. Micromech. Microeng. 6
    (1996) 320; across all eight leaves stretch in pairs, 2 E A / L.
    """
    places = (0.0, 20.0, 60.0, 80.0)
    up = [straight((x, 0), (x, 100)) for x in places]
    down = [straight((x, 0), (x, -100)) for x in places]
    model, ends = frame(
        *up, *down, stages={"upper": (40.0, 100.0), "lower": (40.0, -100.0), "shuttle": (40.0, 0.0)}
    )
    bending = leaves(model, 0.5)
    upper, lower, shuttle = (int(model.mesh.nodes_of(n)[0]) for n in ("upper", "lower", "shuttle"))
    outer, inner = [ends[k][0] for k in (0, 3, 4, 7)], [ends[k][0] for k in (1, 2, 5, 6)]
    model.fix(outer, rotation=True)
    model.rigid([end[1] for end in ends[:4]], upper)
    model.rigid([end[1] for end in ends[4:]], lower)
    model.rigid(inner, shuttle)
    model.force([shuttle], x=24.0 * bending / 1e6 * 10.0)
    model.stage("shuttle", axis="x")
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    return results, [
        ("24 E I / L^3 at the start", results.history("axis stiffness")[0], 24 * bending / 1e6),
        ("lateral stiffness 2 E A / L", results.history("lateral stiffness")[0],
         2 * 1e5 * 0.5 / 100),
        ("parasitic translation / travel at d = L / 10",
         results.history("parasitic translation")[-1] / results.history("travel")[-1], 0.0),
    ]  # fmt: skip


def let() -> tuple[ct.Results, list[Row]]:
    """An outside lamina emergent torsional joint: four legs 2 x 1 x 20 in a sheet 1 thick.

    Two legs in series on each side, both sides in parallel: G K / L out of the plane (Jacobsen,
    Chen, Howell and Magleby, Mech. Mach. Theory 44 (2009) 2098, with rigid connections), with the
    torsion constant a b^3 (16/3 - 3.36 b / a (1 - b^4 / 12 a^4)) of a rectangle 2 a x 2 b (Roark).
    Ours is the soap film of Prandtl over the section. In its plane the joint is a spring of legs
    that bend, 12 E I / L^3: the pull that it must not see.
    """
    length, width, sheet, young, nu = 20.0, 2.0, 1.0, 2.0e3, 0.35
    shear = 0.5 * young / (1.0 + nu)
    constant = torsion_constant(width, sheet)
    a, b = 0.5 * width, 0.5 * sheet
    roark = a * b**3 * (16.0 / 3.0 - 3.36 * b / a * (1.0 - b**4 / (12.0 * a**4)))

    # Right half of the sheet: neck, leg, connection, leg, neck.
    plates = [
        ct.mesh.rectangle(w, h, nx=round(2 * w), ny=round(2 * h), origin=(x, y))
        for x, y, w, h in (
            (0.0, -4.0, 3.0, 4.0),
            (0.0, 0.0, 3.0, width),
            (3.0, 0.0, length, width),
            (3.0 + length, 0.0, 4.0, width),
            (3.0 + length, width, 4.0, 2.0),
            (3.0 + length, 4.0, 4.0, width),
            (3.0, 4.0, length, width),
            (0.0, 4.0, 3.0, width),
            (0.0, 4.0 + width, 3.0, 4.0),
        )
    ]
    model = ct.Model(ct.mesh.merge(*plates))
    model.section("all", element="Q4I", material=ct.Elastic(E=young, nu=nu), thickness=sheet)
    end = 8.0 + width
    model.fix(ct.on_line((0, -4), (3, -4)))
    model.fix(ct.on_line((0, -4), (0, width)), x=0.0, y=None)
    model.fix(ct.on_line((0, 4), (0, end)), x=0.0, y=None)
    top = ct.on_line((0, end), (3, end))
    model.fix(top, x=0.0, y=0.5)
    model.stage("panel", top, axis="y", allowable={"MISES": 30.0})
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    pull = 12.0 * young * sheet * width**3 / 12.0 / length**3
    return results, [
        ("torsion constant of a leg", constant, roark),
        ("stiffness out of the plane G K / L", shear * constant / length, shear * roark / length),
        ("stiffness in the plane 12 E I / L^3", 2 * results.history("axis stiffness")[0], pull),
    ]


def torsion_constant(width: float, height: float) -> float:
    """Torsion constant of a rectangle by the analogy of the soap film (Prandtl 1903).

    With nu = 0 and no motion along x the displacement along y of a plate that is stretched by the
    square root of 2 in x obeys E (v,xx + v,yy) = -b: v = b phi / 2 E, K = 2 times the integral of
    phi, which the strain energy gives.
    """
    young, load = 1.0, 1e-6
    model = ct.Model(ct.mesh.rectangle(width / np.sqrt(2.0), height, nx=40, ny=20, cell="quad8"))
    model.section("all", element="Q8", material=ct.Elastic(E=young, nu=0.0, rho=1.0))
    model.fix("all", x=0.0, y=None)
    for side in ("left", "right", "bottom", "top"):
        model.fix(side, x=None, y=0.0)
    model.gravity(0.0, load)
    energy = ct.solve(model, ct.Static(nlgeom=False), threads=1).history("strain energy")[-1]
    return float(8.0 * np.sqrt(2.0) * young * energy / load**2)


def cosine() -> tuple[ct.Results, list[Row]]:
    """A beam of cosine shape with height 6 t whose middle cannot turn: a bistable switch.

    Qiu, Lang and Slocum, J. MEMS 13 (2004) 137: 740 and 370 E I h / l^3 at 0.16 h and 1.92 h, rest
    at 1.33 h and 1.99 h, for h / t above 6, the second mode suppressed. The third mode branches off
    where the snap begins; an imperfection of 2 % of the thickness leads to it. On that branch the
    axial force is 16 pi^2 E I / l^2, so that F = 64 pi^2 (4/3 - d / h) E I h / l^3 for a flat beam.
    """
    length, rise = 200.0, 6.0
    x = np.linspace(0.0, 0.5 * length, 81)
    shape = 0.5 * rise * (1.0 - np.cos(2.0 * np.pi * x / length))
    shape += 0.01 * (1.0 - np.cos(4.0 * np.pi * x / length))
    model, ((clamp, middle),) = frame(np.column_stack([x, shape]), stages={})
    bending = leaves(model, 1.0)
    model.fix([clamp], rotation=True)
    model.fix([middle], x=0.0, y=-2.2 * rise, rotation=0.0)
    model.stage("middle", [middle], axis=(0.0, -1.0))
    results = ct.solve(model, ct.Static(increments=110), threads=1)
    unit = bending * rise / length**3
    value = {name: float(results.history(name)[-1]) for name in (
        "snap load", "return load", "snap travel", "return travel", "switching travel",
        "second equilibrium")}  # fmt: skip
    travel, load = results.history("travel").values, results.history("load").values
    return results, [
        ("load l^3 / E I h at travel h / 2", 2 * np.interp(0.5 * rise, travel, load) / unit,
         64 * np.pi**2 * (4 / 3 - 1 / 2)),
        ("snap load l^3 / E I h", 2 * value["snap load"] / unit, 740.0),
        ("return load l^3 / E I h", -2 * value["return load"] / unit, 370.0),
        ("travel / h at the snap", value["snap travel"] / rise, 0.16),
        ("travel / h at the return", value["return travel"] / rise, 1.92),
        ("unstable equilibrium / h", value["switching travel"] / rise, 4.0 / 3.0),
        ("second equilibrium / h", value["second equilibrium"] / rise, 1.99),
    ]  # fmt: skip


def v_beam() -> tuple[ct.Results, list[Row]]:
    """Half of a V-shaped thermal actuator at 4 degrees.

    Zhu, Corigliano and Espinosa, J. Micromech. Microeng. 16 (2006) 242, linear:
    alpha dT l sin a / (sin^2 a + cos^2 a 12 I / (A l^2)), and the stiffness of both halves.
    """
    length, slope, thickness, expansion = 100.0, np.radians(4.0), 2.0, 2.5e-6
    end = (length * np.cos(slope), length * np.sin(slope))
    model, ((clamp, apex),) = frame(straight((0, 0), end, 40), stages={})
    bending = leaves(model, thickness, 1.6e5, expansion=expansion)
    model.fix([clamp], rotation=True)
    model.fix([apex], x=0.0, y=None, rotation=0.0)
    model.amplitudes["slowly"] = ct.Amplitude([0.0, 1.0, 2.0], [0.0, 0.01, 1.0])
    model.temperature(400.0, amplitude="slowly")
    model.stage("apex", [apex], axis="y")
    results = ct.solve(model, ct.Static(increments=8, period=2.0), threads=1)
    ratio = thickness**2 / length**2  # 12 I / (A l^2)
    sin, cos = np.sin(slope), np.cos(slope)
    moved = expansion * 4.0 * length * sin / (sin**2 + cos**2 * ratio)
    axial = 1.6e5 * thickness / length
    return results, [
        ("travel of 4 degrees", results.history("travel")[4], moved),
        ("travel of 400 degrees", results.history("travel")[-1], 100.0 * moved),
        ("stiffness of both halves", 2 * results.history("axis stiffness")[0],
         2 * (axial * sin**2 + 12 * bending / length**3 * cos**2)),
    ]  # fmt: skip


JOINTS = {
    "leaf": leaf,
    "cross": cross,
    "notch": notch,
    "parallelogram": parallelogram,
    "double-parallelogram": double_parallelogram,
    "folded": folded,
    "let": let,
    "cosine": cosine,
    "v-beam": v_beam,
}


def main(words: list[str] | None = None) -> None:
    """Print the rows of some joints, or of all."""
    words = words or []
    plot = "--plot" in words
    for name in [word for word in words if word != "--plot"] or list(JOINTS):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            results, rows = JOINTS[name]()
        print(f"{name}: {(JOINTS[name].__doc__ or '').splitlines()[0]}")
        for what, ours, formula in rows:
            apart = f"{100 * (ours / formula - 1):+7.2f} %" if formula else ""
            print(f"  {what:45} {float(ours):12.6g} {formula:12.6g} {apart}")
        if plot:
            results.plot("U", path=Path(f"{name}.png"), title=name, dpi=70.0)


if __name__ == "__main__":
    main(sys.argv[1:])
