"""An audit of contact, written from the pages alone: joints of deformable bodies.

Press fits, laminated beams, slits, pressure laws, heat, axisymmetric and quadratic elements, ties;
with friction where it decides. Closed forms in the docstrings, default settings, one increment a
step.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from support.pairs import cover
from tests.support.blocks import METHODS, STIFF, block, reaction, scalar, solve, step_ends

FLOOR = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))


@pytest.mark.parametrize("turn", [40.0, -110.0])
@pytest.mark.parametrize("slave", ["hub", "shaft"])
def test_torque_capacity_of_a_press_fit_of_two_rings(slave: str, turn: float) -> None:
    """Rings 1 to 2 and 2 to 3, rigid at 1 and 3, overlap by d at 2. With u = C (r - 1/r) and D (r -
    9/r), plane stress: sigma_r = E/(1-nu^2) (u' + nu u/r) equal at 2 and u_hub - u_shaft = d
    give p. Turned beyond slip, in one increment, the joint passes mu p 2 pi 2^2."""
    d, mu, modulus, nu = 4e-3, 0.2, 1e4, 0.3

    def radial(q: float) -> tuple[float, float]:  # u and sigma_r at r = 2 of r - q/r
        u, slope = 2 - q / 2, 1 + q / 4
        return u, modulus / (1 - nu**2) * (slope + nu * u / 2)

    (ui, si), (uo, so) = radial(1.0), radial(9.0)
    p = -d / (uo / so - ui / si)
    n = 48
    shaft = ct.mesh.annulus(1.0, 2.0 + d / 2, 3, n)
    hub = ct.mesh.annulus(2.0 - d / 2, 3.0, 3, n)
    mesh = ct.mesh.assembly(shaft=shaft, hub=hub)
    axis = ct.mesh.add_node(mesh, 0.0, 0.0, "axis")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=nu))
    model.rigid("shaft.inner", axis)
    model.fix("hub.outer")
    pair = ["hub.inner", "shaft.outer"] if slave == "hub" else ["shaft.outer", "hub.inner"]
    model.contact(*pair, friction=mu, name="fit")
    fit, rotate = ct.Static(), ct.Static()
    fit.fix("axis", rotation=0.0)
    rotate.fix("axis", rotation=math.radians(turn))
    results = solve(model, fit, rotate)
    frame = results.frames[-1]
    pressed = frame.C[results.mesh.nodes_of(pair[0]), 0]
    assert pressed.mean() == pytest.approx(p, rel=2e-2)
    torque = math.copysign(mu * p * 2 * math.pi * 4.0, turn)
    assert frame.RF[axis, 2] == pytest.approx(torque, rel=2e-2)


LAYERS: dict[str, tuple[ct.PressureLaw, Any, Any]] = {
    "linear": (ct.PressureLaw("linear", [200.0]), lambda w: 200.0 * w, lambda w: 100.0 * w * w),
    "tabular": (
        ct.PressureLaw("tabular", [0.0, 2.0, 14.0], [0.0, 0.02, 0.05]),
        lambda w: 100.0 * w if w < 0.02 else 2.0 + 400.0 * (w - 0.02),
        lambda w: 50 * w * w if w < 0.02 else 0.02 + 2.0 * (w - 0.02) + 200 * (w - 0.02) ** 2,
    ),
    "exponential": (
        ct.PressureLaw("exponential", [3.0], [0.01]),
        lambda w: 3 / (math.e - 1) * (w / 0.01 + 1) * (math.exp(w / 0.01 + 1) - 1),
        # integral from -c: p0 c / (e - 1) ((z - 1) e^z + 1 - z^2 / 2), z = w/c + 1
        lambda w: (
            0.03
            / (math.e - 1)
            * ((w / 0.01) * math.exp(w / 0.01 + 1) + 1 - (w / 0.01 + 1) ** 2 / 2)
        ),
    ),
}


@pytest.mark.parametrize("law", list(LAYERS))
@pytest.mark.parametrize(
    ("method", "slave"), [("mortar", "upper"), ("mortar", "lower"), ("node_to_segment", "upper")]
)
def test_overlap_and_energy_of_a_layer_and_its_friction(law: str, method: str, slave: str) -> None:
    """A column of nu = 0 under q = 7 sinks by q H / E and by the overlap w with p(w) = q, whose
    energy is the integral of p. Moved aside without tilting, its layer rubs with mu q per area,
    without a change of w."""
    q, mu, area = 7.0, 0.3, 2.0
    curve, pressure, energy = LAYERS[law]
    low, high = -0.01, 0.1
    for _ in range(80):
        mid = (low + high) / 2
        low, high = (mid, high) if pressure(mid) < q else (low, mid)
    w = (low + high) / 2
    lower, upper = block(6.0, 1.0, 9, 2, (-2.0, -1.0)), block(area, 1.0, 4, 2)
    model = ct.Model(ct.mesh.assembly(lower=lower, upper=upper))
    model.section("all", element="Q4", material=ct.Elastic(E=1e6, nu=0.0))
    model.fix("lower.bottom")
    pair = ["upper.bottom", "lower.top"] if slave == "upper" else ["lower.top", "upper.bottom"]
    model.contact(*pair, law=curve, friction=mu, method=method, name="layer")
    press, draw = ct.Static(), ct.Static()
    press.traction("upper.top", y=-q)
    press.fix("upper", x=0.0, y=None)
    draw.fix("upper", x=1.3, y=None)
    results = solve(model, press, draw)
    pressed, drawn = step_ends(results)[-2:]
    top = results.mesh.nodes_of("upper.top")
    assert pressed.U[top, 1].mean() == pytest.approx(-w, abs=2e-5)  # q H / E
    assert pressed.scalars["ALLCL"] == pytest.approx(area * energy(w), rel=2e-3)
    body = results.mesh.nodes_of("upper")
    assert drawn.RF[body, 0].sum() == pytest.approx(mu * q * area, rel=5e-3)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("itself", [False, True])
def test_a_beam_of_two_pressed_leaves(method: str, itself: bool) -> None:
    """Two leaves of height 1 and length L, clamped, are pressed by q. While the shear between them,
    3 F / (2 2h), is below mu q they bend as one beam, I = (2h)^3 / 12; beyond F1 = 4 mu q h / 3
    each alone, with 2 h^3 / 12. Loaded to F = 2 F1 and relieved to F1, which sticks again: d =
    F1 L^3/3E (1/I + 1/I2), then back by F1 L^3 / 3EI. As two surfaces or as one that meets
    itself."""
    length, mu, q, modulus = 20.0, 0.5, 3.0, 1e5
    first = 4 * mu * q / 3
    nx = 20
    model = ct.Model(
        ct.mesh.assembly(a=block(length, 1.0, nx, 2), b=block(length, 1.0, nx, 2, (0.0, 1.0)))
    )
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=0.0))
    model.fix("a.left")
    model.fix("b.left")
    if itself:
        model.contact(
            ["a.top", "b.bottom"], ["a.top", "b.bottom"], friction=mu, method=method, name="slit"
        )
    else:
        model.contact("a.top", "b.bottom", friction=mu, method=method, name="slit")
    press, load, relieve = ct.Static(), ct.Static(), ct.Static()
    press.pressure("b.top", q)
    press.pressure("a.bottom", q)
    for step, force in ((load, 2 * first), (relieve, first)):
        step.force("a.right", y=-force / 2)
        step.force("b.right", y=-force / 2)
    results = solve(model, press, load, relieve)
    one, two = 8.0 / 12.0, 2.0 / 12.0
    bent = first * length**3 / (3 * modulus) * (1 / one + 1 / two)
    back = first * length**3 / (3 * modulus) / one
    tip = results.mesh.nodes_of("a.right")
    down, up = (float(f.U[tip, 1].mean()) for f in step_ends(results)[-2:])
    assert down == pytest.approx(-bent, rel=3e-2)
    assert up - down == pytest.approx(back, rel=3e-2)


def slit_plate(angle: float, nx: int = 6, ny: int = 3) -> tuple[Mesh, np.ndarray]:
    """A plate of 6 x 4 with a closed slit along its middle line, which rises by `angle`; nodes of
    the slit are double."""
    rise = math.tan(math.radians(angle))
    points, index = [], {}
    for half in (0, 1):
        for j in range(ny + 1):
            for i in range(nx + 1):
                x = 6.0 * i / nx
                middle = 2.0 + rise * (x - 3.0)
                bottom, top = (0.0, middle) if half == 0 else (middle, 4.0)
                if half == 1 and j == 0 and i in (0, nx):
                    index[half, i, j] = index[0, i, ny]
                    continue
                index[half, i, j] = len(points)
                points.append((x, bottom + (top - bottom) * j / ny))
    cells = [
        [index[h, i, j], index[h, i + 1, j], index[h, i + 1, j + 1], index[h, i, j + 1]]
        for h in (0, 1)
        for j in range(ny)
        for i in range(nx)
    ]
    mesh = Mesh(
        np.array(points),
        [Cells("quad4", np.array(cells), np.arange(1, len(cells) + 1))],
        np.arange(1, len(points) + 1),
    )
    lower = [((ny - 1) * nx + i, 2) for i in range(nx)]
    upper = [(ny * nx + i, 0) for i in range(nx)]
    mesh.edge_sets["slit"] = np.array(lower + upper)
    mesh.node_sets["bottom"] = np.array([index[0, i, 0] for i in range(nx + 1)])
    mesh.node_sets["top"] = np.array([index[1, i, ny] for i in range(nx + 1)])
    faces = np.array([[index[0, i, ny], index[1, i, 0]] for i in range(1, nx)])
    return mesh, faces


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("angle", [0.0, 10.0, 25.0])
def test_a_closed_slit_below_the_friction_angle_is_not_felt(method: str, angle: float) -> None:
    """A slit at the angle a across a plate under a uniform stress s sticks for mu > tan a: stress,
    p = s cos^2 a and the shear s sin a cos a on it are those of the plate without slit. Self-
    contact, one increment."""
    a, strain, modulus = math.radians(angle), 1e-4, 1e5
    mesh, faces = slit_plate(angle)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=modulus, nu=0.25))
    model.fix("bottom", x=None, y=0.0)
    model.fix([0], x=0.0, y=0.0)
    model.fix("top", x=None, y=-4.0 * strain)
    model.contact("slit", "slit", friction=math.tan(a) + 0.05, method=method, name="slit")
    results = solve(model)
    s = modulus * strain
    assert reaction(results, "top")[1] == pytest.approx(-6.0 * s, rel=1e-3)
    stress = np.concatenate(
        [f.values["S"].reshape(-1, f.values["S"].shape[-1]) for f in results.frames[-1].fields]
    )
    assert stress[:, 1] == pytest.approx(np.full(len(stress), -s), rel=1e-3)
    pressed = results.frames[-1].C[faces[1:-1]]
    active = np.abs(pressed[:, :, 0]).max(axis=1)
    assert active == pytest.approx(np.full(len(active), s * math.cos(a) ** 2), rel=1e-3)
    sheared = np.abs(pressed[:, :, 1]).max(axis=1)
    assert sheared == pytest.approx(
        np.full(len(active), s * math.sin(a) * math.cos(a)), rel=1e-3, abs=1e-6
    )


@pytest.mark.parametrize("gap", [0.0, 0.004, 0.02])
@pytest.mark.parametrize("method", METHODS)
def test_heat_closes_a_gap_between_two_bars(gap: float, method: str) -> None:
    """Bars of 4 and 6 with E and 3 E between walls, g apart, heated: free growth a dT L - g, if
    positive, is taken back by F (4 / E + 6 / 3E) with sections of 1."""
    modulus, growth = 1e4, 1e-3
    a, b = block(4.0, 1.0, 4, 2), block(6.0, 1.0, 6, 3, (4.0 + gap, 0.0))
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("a", element="Q4I", material=ct.Elastic(E=modulus, nu=0.3, expansion=1e-5))
    model.section("b", element="Q4I", material=ct.Elastic(E=3 * modulus, nu=0.3, expansion=1e-5))
    model.fix("a.left", x=0.0, y=None)
    model.fix("b.right", x=0.0, y=None)
    model.fix([0], x=0.0, y=0.0)
    model.fix([model.mesh.nodes_of("b.right")[0]], x=0.0, y=0.0)
    model.temperature(100.0)
    model.contact("a.right", "b.left", friction=0.2, method=method, name="gap")
    results = solve(model)
    force = max(0.0, (growth * 10.0 - gap) / (4 / modulus + 6 / (3 * modulus)))
    assert scalar(results, "gap: force x") == pytest.approx(-force, rel=3e-3, abs=1e-6)


@pytest.mark.parametrize(("mu", "method"), cover([0.0, 0.15], METHODS, strength=1))
def test_a_thin_ring_is_pushed_on_a_cone(mu: float, method: str) -> None:
    """A thin ring (R = 50, section 1 x .5) is pushed along a rigid cone of 5 degrees by z: hoop
    force E A z tan(a) / R, radial load that by R, and the push is 2 pi R times it times tan(a +
    phi). Drawn back a little it reverses: tan(a - phi)."""
    a, radius, modulus = math.radians(5.0), 50.0, 2e5
    phi, z = math.atan(mu), 0.2
    rise = math.tan(a)
    mesh = ct.mesh.mapped(
        [
            (radius - 0.5 * rise, -0.5),
            (radius + 0.5, -0.5),
            (radius + 0.5, 0.5),
            (radius + 0.5 * rise, 0.5),
        ],
        2,
        4,
    )
    model = ct.Model(mesh)
    model.section(
        "all", element="Q4I", plane="axisymmetric", material=ct.Elastic(E=modulus, nu=0.0)
    )
    t = np.array([math.sin(a), math.cos(a)])
    cone = ct.RigidCurve.line(np.array([radius, 0]) + 40 * t, np.array([radius, 0]) - 40 * t)
    model.contact("left", cone, friction=mu, method=method, name="cone")
    on, back = ct.Static(), ct.Static()
    # the cone widens along y: the ring is pushed towards +y
    on.fix("top", x=None, y=z)
    back.fix("top", x=None, y=z - 0.02)
    results = solve(model, on, back)
    ends = step_ends(results)[-2:]
    top = mesh.nodes_of("top")
    for frame, move, angle in zip(ends, (z, z - 0.02), (a + phi, a - phi), strict=True):
        mean = radius + 0.25
        hoop = modulus * 0.5 * move * rise / mean
        push = 2 * math.pi * hoop * math.tan(angle)
        assert frame.RF[top, 1].sum() == pytest.approx(push, rel=2e-2)


@pytest.mark.parametrize(
    ("upper", "lower"),
    [("Q8", "Q8R"), ("Q9", "T6"), ("T6", "Q4I"), ("OPT", "Q8"), ("Q4D", "Q9"), ("T3", "Q4R")],
)
@pytest.mark.parametrize("method", METHODS)
def test_elements_of_any_kind_rub_on_each_other(upper: str, lower: str, method: str) -> None:
    """A block is drawn over a table of another element in one increment of more than a cell: mu P,
    and P at the place that the moment of the pull gives."""
    cell = {"Q8": "quad8", "Q8R": "quad8", "Q9": "quad9", "T6": "tri6", "OPT": "tri3", "T3": "tri3"}
    mu, load, travel = 0.25, 6.0, 0.7
    bodies = {
        "upper": block(2.0, 0.5, 4, 1, (0.0, 0.0), cell=cell.get(upper, "quad4")),
        "lower": block(5.0, 0.5, 7, 1, (-1.0, -0.5), cell=cell.get(lower, "quad4")),
    }
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("upper", element=upper, material=STIFF)
    model.section("lower", element=lower, material=STIFF)
    model.fix("lower.bottom")
    model.force("upper.top", y=-load)
    model.fix("upper.top", x=travel, y=None)
    model.contact("upper.bottom", "lower.top", friction=mu, method=method, name="joint")
    results = solve(model)
    assert reaction(results, "upper.top")[0] == pytest.approx(mu * load, rel=1e-4)
    assert scalar(results, "joint: force y") == pytest.approx(load, rel=1e-4)
    assert scalar(results, "joint: moment") == pytest.approx(
        load * (1.0 + travel + mu * 0.5), rel=2e-3
    )


@pytest.mark.parametrize("coarse", ["slave", "master"])
def test_tied_columns_in_series(coarse: str) -> None:
    """Columns of nu = 0 with E and 4 E, tied by meshes that do not match, beside a rigid wall that
    they do not reach: q (1 / E + 2 / 4E) down, and a shear t bends nothing when the top is
    guided: t (1 / G + 2 / 4G) aside."""
    q, t, modulus = 2.0, 1.0, 1e5
    a = block(3.0, 1.0, 5 if coarse == "slave" else 8, 2, (0.0, 2.0))
    b = block(3.0, 2.0, 8 if coarse == "slave" else 5, 3)
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("a", element="Q4", material=ct.Elastic(E=modulus, nu=0.0))
    model.section("b", element="Q4", material=ct.Elastic(E=4 * modulus, nu=0.0))
    model.fix("b.bottom")
    model.tie("a.bottom", "b.top", name="tie")
    model.pressure("a.top", q)
    for s, sign in (("right", 1.0), ("left", -1.0)):
        for body in "ab":
            model.traction(f"{body}.{s}", y=sign * t)
    model.traction("a.top", x=t)
    results = solve(model, ct.Static(nlgeom=False))
    top = results.mesh.nodes_of("a.top")
    shear = modulus / 2
    assert results.frames[-1].U[top, 1] == pytest.approx(
        np.full(len(top), -q * (1 / modulus + 2 / (4 * modulus))), rel=1e-8
    )
    assert results.frames[-1].U[top, 0] == pytest.approx(
        np.full(len(top), t * (1 / shear + 2 / (4 * shear))), rel=1e-8
    )


@pytest.mark.parametrize(
    ("start", "at_half", "at_end"), [("keep", 1.0, 1.0), ("ramp", 0.5, 1.0), ("adjust", 0.0, 0.0)]
)
def test_an_overlap_of_two_held_blocks_and_its_friction(
    start: Any, at_half: float, at_end: float
) -> None:
    """Columns of 1 and 2 between walls overlap by d: p = E d / 3 at once, over the first step, or
    not at all. Then the upper is drawn aside: mu p."""
    d, modulus, mu = 3e-4, 1e5, 0.4
    a, b = block(2.0, 1.0, 4, 2, (0.0, 2.0 - d)), block(4.0, 2.0, 7, 3, (-1.0, 0.0))
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("all", element="Q4", material=ct.Elastic(E=modulus, nu=0.0))
    model.fix("b.bottom")
    model.contact("a.bottom", "b.top", friction=mu, start=start, name="joint")
    fit, draw = ct.Static(increments=2), ct.Static()
    fit.fix("a.top", x=0.0, y=0.0)
    draw.fix("a.top", x=0.5, y=0.0)
    results = solve(model, fit, draw)
    half = results.frames[1]
    # the lower block is twice as wide: a uniform column of 1 on a half-wide one: its stiffness
    # from its own pressing
    whole = step_ends(results)[-2].scalars["joint: force y"]
    if at_end:
        assert half.scalars["joint: force y"] == pytest.approx(at_half * whole, rel=1e-2)
        assert 2.0 * modulus * d / 3 < whole < 2.0 * modulus * d / 2
    else:
        assert whole == pytest.approx(0.0, abs=1e-6)
    last = results.frames[-1]
    top = results.mesh.nodes_of("a.top")
    assert last.RF[top, 0].sum() == pytest.approx(
        mu * last.scalars["joint: force y"], rel=1e-3, abs=1e-6
    )
