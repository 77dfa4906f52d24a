"""Checks of contact of beams, rings, solids of revolution, rubber and metal; see contact_audit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

import corota as ct
from benchmarks.campaigns.contact_audit_statics import (
    CELLS,
    Row,
    box,
    check,
    largest_factor,
    pull,
    solids,
    sprung_block,
    variants,
)


def last(results: ct.Results, name: str, at: str, step: int = 0) -> float:
    """Last value of a history at a set, of a step if given."""
    values = results.history(name, at=at)
    if step:
        return float(values[np.flatnonzero(results.history("step") == step)[-1]])
    return float(values[-1])


# --- beams ----------------------------------------------------------------------------------------


@check(friction=False)
def cantilever_with_a_stop_at_its_middle() -> Iterator[Row]:
    """Before the stop 3 EI / L^3, then that of the propped beam: 96 EI / 7 L^3."""
    length, gap, load, EI = 10.0, 0.05, 3.0, 1e3 / 12.0 * 10.0
    for method, solid in variants((False, True)):
        for path in (None, ct.ArcLength(factor=1.0)):
            stop = ct.RigidCurve.circle((5.0, -1.5 - gap), 1.0)
            if solid:
                model = solids("Q8R", E=1e4, beam=box("Q8R", length, 1.0, 40, 2, (0.0, -0.5)))
                model.sections[0].material = ct.Elastic(E=1e4)
                model.contact("beam.bottom", stop, method=method, name="stop")
                model.fix("beam.left")
                model.force("beam.right", y=-load)
                tip = "beam.right"
            else:
                model = ct.Model(ct.mesh.line([(0.0, 0.0), (length, 0.0)], n=20))
                model.beam("all", material=ct.Elastic(E=1e4), area=1.0, inertia=1.0 / 12.0)
                model.contact("all", stop, method=method, name="stop")
                model.fix("start", rotation=True)
                model.force("end", y=-load)
                tip = "end"
            results = ct.solve(model, ct.Static(nlgeom=False, path=path))
            # Deflection at the middle by the load 5 P L^3 / 48 EI and by the stop R L^3 / 24 EI,
            # with the shear of the solid.
            shear = EI / length**2 / (1e4 / 2.0 / 1.2) * (0.5 if solid else 0.0)
            reaction = 5.0 * load / 48.0 + load * shear - gap * EI / length**3
            reaction /= 1.0 / 24.0 + shear
            exact = load * (1.0 / 3.0 + 2.0 * shear) - reaction * (5.0 / 48.0 + shear)
            exact *= -(length**3) / EI
            name = f"{method} {'solid' if solid else 'beam'}{' path' if path else ''}"
            yield f"{name} reaction", pull(results, "stop", "force y"), reaction, 0.02
            yield f"{name} tip", last(results, "U2", tip), exact, 0.03


@check(friction=False)
def cantilever_wraps_a_cylinder() -> Iterator[Row]:
    """From P L = EI / R on it lies on it up to L - EI / P R."""
    length, radius, EI, load = 10.0, 200.0, 1000.0, 1.25
    lies = length - EI / (load * radius)
    exact = lies**2 / (2.0 * radius) + lies / radius * (length - lies)
    exact += load * (length - lies) ** 3 / (3.0 * EI)
    for method, n in variants((40, 80)):
        model = ct.Model(ct.mesh.line([(0.0, 0.0), (length, 0.0)], n=n))
        model.beam("all", material=ct.Elastic(E=1e5), area=1.0, inertia=0.01)
        half = 0.5 * math.sqrt(12.0 * 0.01)
        center = (0.0, -radius - half)
        model.contact("all", ct.RigidCurve.circle(center, radius), method=method, name="roll")
        model.fix("start", rotation=True)
        model.force("end", y=-load)
        results = ct.solve(model, ct.Static(nlgeom=False))
        yield f"{method} {n} elements", -last(results, "U2", "end"), exact, 0.01


@check(friction=False)
def beam_lifted_from_the_floor() -> Iterator[Row]:
    """Lifted by w, a heavy beam is off the floor over (72 EI w / q)^(1/4) on both sides."""
    q, EI, lift = 1.0, 1000.0, 0.2
    free = (72.0 * EI * lift / q) ** 0.25
    for method, n, clearance in variants((60, 120), (False, True)):
        model = ct.Model(ct.mesh.line([(-20.0, 0.5), (0.0, 0.5), (20.0, 0.5)], n=n // 2))
        model.beam("all", material=ct.Elastic(E=1.2e4), area=1.0, inertia=1.0 / 12.0)
        floor = ct.RigidCurve.line((-30.0, 0.0), (30.0, 0.0))
        options = {"clearance": 0.0} if clearance else {}
        model.contact("all", floor, method=method, name="floor", **options)
        model.line_load(y=-q)
        model.fix("corner_1", x=0.0, y=lift)
        results = ct.solve(model, ct.Static(nlgeom=False))
        force = last(results, "RF2", "corner_1")
        yield f"{method} {n}{' clearance' if clearance else ''}", force, 4.0 * q * free / 3.0, 0.01


@check(friction=False)
def beam_on_a_layer_that_does_not_pull() -> Iterator[Row]:
    """A force in its middle: half of the contact is pi / 2 over (k / 4 EI)^(1/4)."""
    k, EI, load = 0.4, 1000.0, 10.0
    beta = (k / (4.0 * EI)) ** 0.25
    length = math.pi / (2.0 * beta)
    # w = sum of the four solutions; w'(0) = 0, V(0) = P / 2, and w, w'' , w''' vanish at the end:
    # the fifth condition gives the length.
    root = beta * np.array([1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j])
    rows = [root, root**3, root**2 * np.exp(root * length), np.exp(root * length)]
    right = [0.0, load / (2.0 * EI), 0.0, 0.0]
    middle = float(np.linalg.solve(np.array(rows), np.array(right)).sum().real)
    shear = np.linalg.solve(np.array(rows), np.array(right)) @ (root**3 * np.exp(root * length))
    assert abs(shear) < 1e-12
    for method, n in variants((40, 80)):
        model = ct.Model(ct.mesh.line([(-30.0, 0.5), (0.0, 0.5), (30.0, 0.5)], n=n // 2))
        model.beam("all", material=ct.Elastic(E=1.2e4), area=1.0, inertia=1.0 / 12.0)
        floor = ct.RigidCurve.line((-40.0, 0.0), (40.0, 0.0))
        layer = ct.PressureLaw("linear", k)
        model.contact("all", floor, law=layer, method=method, name="layer")
        model.fix("corner_1", y=None)
        model.force("corner_1", y=-load)
        results = ct.solve(model, ct.Static(nlgeom=False))
        yield f"{method} {n} elements", -last(results, "U2", "corner_1"), abs(middle), 0.01


@check(friction=False)
def flange_pries_on_its_bolts() -> Iterator[Row]:
    """Half of a T: a beam pulled at the web, a bolt, and a tip that presses on the floor."""
    EI, pulled, to_bolt, to_tip, bolt = 1000.0, 10.0, 4.0, 3.0, 100.0
    length = to_bolt + to_tip
    # Guided at the web (no rotation, force up), spring at the bolt, support at the tip: by the
    # deflections of a cantilever clamped at the web, relative to the web.
    bend = (
        np.array(
            [
                [to_bolt**3 / 3.0, to_bolt**2 * (3.0 * length - to_bolt) / 6.0],
                [to_bolt**2 * (3.0 * length - to_bolt) / 6.0, length**3 / 3.0],
            ]
        )
        / EI
    )
    # Unknown: bolt force B (down), prying Q (up), lift of the web w: B - Q = F; at the bolt
    # w - f_bb B + f_bt Q = B / k; at the tip w - f_tb B + f_tt Q = 0.
    matrix = np.array(
        [
            [1.0, -1.0, 0.0],
            [-bend[0, 0] - 1.0 / bolt, bend[0, 1], 1.0],
            [-bend[1, 0], bend[1, 1], 1.0],
        ]
    )
    _, pry, lift = np.linalg.solve(matrix, [pulled, 0.0, 0.0])
    for method, both in variants((False, True)):
        points = [(0.0, 0.5), (to_bolt, 0.5), (length, 0.5)]
        if both:
            points = [(-x, y) for x, y in points[:0:-1]] + points
        flange = ct.mesh.line(points, n=8)
        model = ct.Model(flange)
        model.beam("all", material=ct.Elastic(E=1.2e4), area=1.0, inertia=1.0 / 12.0)
        x = flange.points[:, 0]
        bolts = np.flatnonzero(np.abs(np.abs(x) - to_bolt) < 1e-9)
        web = np.flatnonzero(np.abs(x) < 1e-9)
        mesh = flange
        mesh.cells.append(ct.Cells("point1", bolts[:, None], np.arange(len(bolts)) + 1000))
        model.spring(np.arange(mesh.n_cells - len(bolts), mesh.n_cells), bolt, "y")
        floor = ct.RigidCurve.line((-20.0, 0.0), (20.0, 0.0))
        model.contact("all", floor, method=method, name="floor")
        model.fix(web, y=None, rotation=True)
        model.force(web, y=pulled * (2.0 if both else 1.0))
        results = ct.solve(model, ct.Static(nlgeom=False))
        sides = 2.0 if both else 1.0
        name = f"{method} {'both halves' if both else 'half'}"
        yield f"{name}, prying", pull(results, "floor", "force y") / sides, pry, 1e-3
        yield f"{name}, lift", float(results.frames[-1].U[web[0], 1]), lift, 1e-3


@check(friction=True)
def three_leaves_stick_or_slide() -> Iterator[Row]:
    """Pressed leaves that stick bend as one (27 times as stiff as three that slide)."""
    length, h, load, E = 20.0, 0.5, 0.3, 1e5
    for method, element, mu in variants(("Q4I", "Q8R"), (0.0, 1e6)):
        n = {"Q4I": (40, 2), "Q8R": (20, 1)}[element]
        leaves = {name: box(element, length, h, *n, (0.0, k * h)) for k, name in enumerate("abc")}
        model = solids(element, E=E, **leaves)
        for section in model.sections:
            section.material = ct.Elastic(E=E)
        for lower, upper in ("ab", "bc"):
            pair = f"{upper}.bottom", f"{lower}.top"
            model.contact(*pair, friction=mu, method=method, name=lower, separates=mu > 0.0)
        model.fix(["a.left", "b.left", "c.left"])
        model.pressure("c.top", 10.0)
        model.pressure("a.bottom", 10.0)
        press, bend = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
        for name in "abc":
            bend.force(f"{name}.right", y=-load / 3.0)
        results = ct.solve(model, [press, bend])
        start, end = (last(results, "U2", "b.right", step) for step in (1, 2))
        single = load * length**3 / (3.0 * E * h**3 / 12.0)
        # With the shear deflection 1.2 P L / G A of the whole.
        exact = single / (27.0 if mu else 3.0) + 1.2 * load * length / (E / 2.0 * 3.0 * h)
        yield f"{method} {element} {'stick' if mu else 'slide'}", start - end, exact, 0.01


# --- rings and solids of revolution -----------------------------------------------------------


@check(friction=False)
def ring_between_three_rollers() -> Iterator[Row]:
    """F R^3 / 2 EI ((a + sin a cos a) / 2 sin^2 a - 1 / a) of a thin ring, a = 60 degrees."""
    radius, thick, way = 10.0, 0.2, 0.02
    a = math.pi / 3.0
    stiff = 0.5 * ((a + math.sin(a) * math.cos(a)) / (2.0 * math.sin(a) ** 2) - 1.0 / a)
    exact = way * 1e5 * thick**3 / 12.0 / (stiff * radius**3)
    for method, element, friction in variants(("Q4I", "Q8R"), (0.0, 0.3)):
        n = {"Q4I": (2, 180), "Q8R": (1, 90)}[element]
        inner, outer = radius - thick / 2.0, radius + thick / 2.0
        mesh = ct.mesh.annulus(inner, outer, *n, cell=CELLS[element])
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=1e5))
        for k, degrees in enumerate((90.0, 210.0, 330.0)):
            out = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
            ct.mesh.add_node(mesh, *(out * (outer + 3.0)), f"{k}")
            roller = ct.RigidCurve.circle(out * (outer + 3.0), 3.0, reference=f"{k}")
            model.contact("outer", roller, friction=friction, method=method, name=f"roller {k}")
            model.fix(f"{k}", x=-way * out[0], y=-way * out[1], rotation=True)
        model.fix(np.flatnonzero(np.hypot(*(mesh.points - [0.0, inner]).T) < 1e-9), y=None)
        results = ct.solve(model)
        force = -pull(results, "roller 0", "force y")
        yield f"{method} {element} mu {friction}", force, exact, 0.02


@check(friction=False)
def heated_disc_fills_a_hole() -> Iterator[Row]:
    """A ring with a small bore, heated in a rigid hole: Lame's pressure after the gap."""
    inner, outer, gap, E, nu, heat = 0.2, 1.0, 5e-4, 1e5, 0.3, 100.0
    free = 1e-5 * heat * outer - gap
    soft = (outer / E) * ((outer**2 + inner**2) / (outer**2 - inner**2) - nu)
    for method, element in variants(("Q4I", "Q8", "Q9", "T6", "OPT", "Q4R", "Q4D")):
        mesh = ct.mesh.annulus(inner, outer, 8, 60, cell=CELLS[element])
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=E, nu=nu, expansion=1e-5))
        hole = ct.RigidCurve.circle((0.0, 0.0), outer + gap, inside=True)
        model.contact("outer", hole, friction=0.2, method=method, name="hole")
        model.fix("inner", x=None, y=None)
        model.temperature(heat)
        for node, direction in ((0.0, "y"), (90.0, "x"), (180.0, "y")):
            place = inner * np.array([math.cos(math.radians(node)), math.sin(math.radians(node))])
            at = np.flatnonzero(np.hypot(*(mesh.points - place).T) < 1e-9)
            model.fix(at, **{"x": None, "y": None, direction: 0.0})
        results = ct.solve(model)
        pressure = results.nodal("CPRESS")
        on = np.flatnonzero(pressure > 0.0)
        mean = float(results.nodal("CPRESS")[on].mean()) if len(on) else 0.0
        yield f"{method} {element} mean", mean, free / soft, 0.02
        yield f"{method} {element} spread", float(np.ptp(pressure[on])) / mean, 0.0, 0.05


@check(friction=False)
def three_rings_shrunk_on_one_another() -> Iterator[Row]:
    """Both pressures of a compound tube by Lame; the middle ring is slave and master."""
    radii, overlap, E, nu = (1.0, 1.4, 1.8, 2.4), (1e-3, 1.5e-3), 1e5, 0.3

    def soft(a: float, b: float, at: float, of: float) -> float:
        """Radial displacement at a radius by a unit pressure on the surface `of`."""
        sign = 1.0 if of == a else -1.0
        c = a if of == a else b
        other = b if of == a else a
        k = c**2 / (b**2 - a**2) * sign
        return k / E * ((1.0 - nu) * at + (1.0 + nu) * other**2 / at)

    a, b, c, d = radii
    matrix = np.array(
        [
            [soft(b, c, b, b) - soft(a, b, b, b), soft(b, c, b, c)],
            [-soft(b, c, c, b), soft(c, d, c, c) - soft(b, c, c, c)],
        ]
    )
    exact = np.linalg.solve(matrix, overlap)
    for method, element, turned in variants(("Q4I", "Q8R", "OPT"), (False, True)):
        n = {"Q4I": (4, 48), "Q8R": (2, 24), "OPT": (6, 60)}[element]
        meshes = {}
        inner = [a, b - overlap[0], c - overlap[1]]
        for k, name in enumerate("abc"):
            meshes[name] = ct.mesh.annulus(
                inner[k], (b, c, d)[k], n[0], n[1] + 4 * k, angle=90.0, cell=CELLS[element]
            )
        model = solids(element, E=E, **meshes)
        for k, (lower, upper) in enumerate(("ab", "bc")):
            pair = [f"{upper}.inner", f"{lower}.outer"]
            if turned:
                pair.reverse()
            model.contact(*pair, method=method, name=f"joint {k}")
        for name in "abc":
            model.fix(f"{name}.start", x=None, y=0.0)
            model.fix(f"{name}.end", x=0.0, y=None)
        results = ct.solve(model, ct.Static(nlgeom=False))
        for k, radius in enumerate((b, c)):
            force = abs(pull(results, f"joint {k}", "force y")) / radius
            name = f"{method} {element}{' turned' if turned else ''} joint {k}"
            # Facets of the master lie h^2 / 8 R too deep with node to segment, as the page says.
            facet = radius * (0.5 * math.pi / n[1]) ** 2 / 8.0 / overlap[k]
            yield name, force, float(exact[k]), 0.02 + (facet if "node" in method else 0.0)


@check(friction=True)
def shaft_drawn_from_a_hub() -> Iterator[Row]:
    """The axial force is mu times Lame's pressure times the area, in one increment."""
    mu, overlap, E = 0.15, 1e-3, 1e5
    radius, outer, length = 1.0, 2.0, 1.0
    # nu = 0: the shaft gives p r / E, the hub p r / E (b^2 + r^2) / (b^2 - r^2).
    ratio = (outer**2 + radius**2) / (outer**2 - radius**2)
    pressure = overlap / (radius / E * (1.0 + ratio))
    exact = mu * pressure * 2.0 * math.pi * radius * length
    for method, element, swapped in variants(("Q4I", "Q8R", "T6"), (False, True)):
        model = ct.Model(
            ct.mesh.assembly(
                shaft=box(element, radius + overlap / 2, length, 6, 8),
                hub=box(element, outer - radius, length, 5, 7, (radius - overlap / 2, 0.0)),
            )
        )
        material = ct.Elastic(E=E, nu=0.0)
        model.section("all", element=element, material=material, plane="axisymmetric")
        pair = ["hub.left", "shaft.right"]
        if swapped:
            pair.reverse()
        model.contact(*pair, friction=mu, method=method, name="fit")
        model.fix("hub.bottom", x=None, y=0.0)
        hold, draw = ct.Static(), ct.Static()
        hold.fix("shaft.bottom", x=None, y=0.0)
        draw.fix("shaft.bottom", x=None, y=-0.01)
        results = ct.solve(model, [hold, draw])
        force = -last(results, "RF2", "shaft.bottom")
        yield f"{method} {element}{' swapped' if swapped else ''}", force, exact, 0.03


@check(friction=True)
def hot_hub_shrinks_on_a_shaft() -> Iterator[Row]:
    """A hub put on hot with a clearance and cooled presses and holds as by its overlap."""
    mu, E, alpha, heat = 0.2, 1e5, 1e-5, 200.0
    radius, outer, length, overlap = 1.0, 1.5, 0.6, 8e-4
    ratio = (outer**2 + radius**2) / (outer**2 - radius**2)
    pressure = overlap / (radius / E * (1.0 + ratio))
    for method, element in variants(("Q4I", "Q8")):
        mesh = ct.mesh.assembly(
            shaft=box(element, radius, length, 5, 6),
            hub=box(element, outer - radius, length, 5, 5, (radius - overlap, 0.0)),
        )
        model = ct.Model(mesh)
        for part, expansion in (("shaft", 0.0), ("hub", alpha)):
            material = ct.Elastic(E=E, nu=0.0, expansion=expansion)
            model.section(part, element=element, material=material, plane="axisymmetric")
        model.contact(
            "hub.left", "shaft.right", friction=mu, method=method, name="fit", steps=[2, 3]
        )
        hot, cool, draw = ct.Static(), ct.Static(), ct.Static()
        hot.temperature(heat)
        cool.temperature(0.0)
        model.fix("hub.bottom", x=None, y=0.0)
        for step, way in ((hot, 0.0), (cool, 0.0), (draw, -0.01)):
            step.fix("shaft.bottom", x=None, y=way)
        results = ct.solve(model, [hot, cool, draw])
        area = 2.0 * math.pi * radius * length
        force = -last(results, "RF2", "shaft.bottom", 3)
        yield f"{method} {element} drawn", force, mu * pressure * area, 0.03


@check(friction=True)
def spinning_sleeve_hangs_in_a_bore() -> Iterator[Row]:
    """Pressed on its bore by its spin alone, a sleeve is drawn along with mu m w^2 r."""
    inner, outer, length, rho, omega, mu = 0.95, 1.0, 0.4, 2.0, 50.0, 0.3
    # The moment of mass about the axis, of a sleeve whose hoop carries nothing: bore at its radius.
    for method, element in variants(("Q4I", "Q8R")):
        model = ct.Model(box(element, outer - inner, length, 2, 8, (inner, 0.0)))
        material = ct.Elastic(E=1e5, nu=0.0, rho=rho)
        model.section("all", element=element, material=material, plane="axisymmetric")
        bore = ct.RigidCurve.line((outer, -2.0), (outer, 2.0))
        model.contact("right", bore, friction=mu, method=method, name="bore")
        model.centrifugal(omega)
        spin, draw = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
        for step, way in ((spin, 0.0), (draw, -0.02)):
            step.fix("bottom", x=None, y=way)
        results = ct.solve(model, [spin, draw])

        # Radial equilibrium with u = 0 at the bore: u = A r + B / r - rho w^2 r^3 / 8 E (nu = 0).
        c = rho * omega**2 / (8.0 * 1e5)
        matrix = [[outer, 1.0 / outer], [1.0, -1.0 / inner**2]]
        A, B = np.linalg.solve(matrix, [c * outer**3, 3.0 * c * inner**2])
        pressure = -1e5 * (A - B / outer**2 - 3.0 * c * outer**2)
        exact = mu * pressure * 2.0 * math.pi * outer * length
        yield f"{method} {element}", -last(results, "RF2", "bottom"), exact, 0.02


@check(friction=False)
def plate_on_a_ring() -> Iterator[Row]:
    """A round plate lies on the edge of a tube: Timoshenko's plate with an overhang."""
    radius, h, nu, E, load = 10.0, 0.4, 0.3, 1e5, 10.0
    D = E * h**3 / (12.0 * (1.0 - nu**2))
    for method, element, n in variants(("Q8R", "Q4I"), (48, 96)):
        model = ct.Model(box(element, radius * 1.2, h, n, 4))
        model.section("all", element=element, material=ct.Elastic(E=E, nu=nu), plane="axisymmetric")
        tube = ct.RigidCurve.circle((radius, -3.0), 3.0)
        model.contact("bottom", tube, method=method, name="tube")
        on_top = np.flatnonzero((model.mesh.points[:, 1] == h) & (model.mesh.points[:, 0] < 0.45))
        model.force(on_top, y=-load, total=True)
        results = ct.solve(model, ct.Static(nlgeom=False))
        middle = np.flatnonzero((model.mesh.points[:, 1] == 0.0) & (model.mesh.points[:, 0] == 0.0))
        sunk = -float(results.frames[-1].U[middle[0], 1])
        # Overhang 0.2 R stiffens: Timoshenko's plate of radius b on a support of radius R.
        b = 1.2 * radius
        stiff = (3.0 + nu) / (1.0 + nu) - (1.0 - nu) / (1.0 + nu) * (1.0 - (radius / b) ** 2)
        exact = load * radius**2 / (16.0 * math.pi * D) * stiff
        yield f"{method} {element} {n}", sunk, exact, 0.04 if n == 48 else 0.02


# --- punches and Hertz ------------------------------------------------------------------------


def graded(width: float, depth: float, fine: float, n: int, m: int) -> ct.Mesh:
    """Block below y = 0 with cells of about `fine` at the origin that grow to all sides."""
    grow = np.geomspace(1.0, 1.0 + width / fine / n * 2.0, n)
    x = np.concatenate(([0.0], np.cumsum(grow)))
    x *= width / x[-1]
    down = np.concatenate(([0.0], np.cumsum(np.geomspace(1.0, 1.0 + depth / fine / m * 2.0, m))))
    down *= depth / down[-1]
    mesh = ct.mesh.rectangle(1.0, 1.0, 2 * n, m)
    column = np.rint(mesh.points[:, 0] * 2 * n).astype(int)
    row = np.rint(mesh.points[:, 1] * m).astype(int)
    both = np.concatenate((-x[:0:-1], x))
    mesh.points[:, 0] = both[column]
    mesh.points[:, 1] = -down[::-1][row]
    return mesh


@check(friction=False)
def flat_punch_under_an_eccentric_load() -> Iterator[Row]:
    """Its tilt: from e = a / 2 on its contact is 4 (a - e) long, at the loaded end.

    It converges with the first power of the edge, for its pressure is singular.
    """
    for method, n, e in variants((40, 80), (0.3, 0.7)):
        mesh = graded(20.0, 20.0, 1.5 / n, n, n)
        ct.mesh.add_node(mesh, 0.0, 0.0, "punch")
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3), plane="strain")
        model.fix("bottom")
        outline = [(-1.0, 3.0), (-1.0, 0.0), (1.0, 0.0), (1.0, 3.0)]
        punch = ct.RigidCurve.polyline(outline[::-1], reference="punch")
        model.contact("top", punch, method=method, name="punch")
        model.fix("punch", x=0.0, y=None)
        model.force("punch", y=-1.0, moment=-e)
        results = ct.solve(model)
        # Tilt of the contact by a moment M on its half width b: 4 M / pi b^2 E*.
        half = min(1.0, 2.0 * (1.0 - e))
        moment = e - (1.0 - half)
        exact = -4.0 * moment * (1.0 - 0.09) / (math.pi * half**2 * 1e4)
        yield f"{method} {n} e {e}", last(results, "UR3", "punch"), exact, 10.0 / n


@check(friction=False)
def wedge_and_cone_pressed_into_a_block() -> Iterator[Row]:
    """Sneddon's cone: a = 2 d / pi tan, P = 2 E* d^2 / pi tan."""
    E, nu, slope, way = 1e4, 0.3, 0.05, 0.05
    exact = 2.0 * E / (1.0 - nu**2) * way**2 / (math.pi * slope)
    for method, element in variants(("Q4I", "Q4R")):
        mesh = graded(20.0, 20.0, 0.02, 80, 80)
        keep = mesh.points[:, 0] >= -1e-9
        del keep
        n = 80
        half = ct.mesh.rectangle(1.0, 1.0, n, n)
        x = np.sort(np.unique(mesh.points[:, 0]))[n:]
        y = np.sort(np.unique(mesh.points[:, 1]))
        half.points[:] = np.column_stack(
            (
                x[np.rint(half.points[:, 0] * n).astype(int)],
                y[np.rint(half.points[:, 1] * n).astype(int)],
            )
        )
        ct.mesh.add_node(half, 0.0, 0.0, "cone")
        model = ct.Model(half)
        material = ct.Elastic(E=E, nu=nu)
        model.section("all", element=element, material=material, plane="axisymmetric")
        model.fix("bottom", x=None)
        cone = ct.RigidCurve.line((20.0, 20.0 * slope), (-0.5, -0.5 * slope), reference="cone")
        model.contact("top", cone, method=method, name="cone")
        model.fix("cone", x=0.0, y=-way)
        results = ct.solve(model, ct.Static(nlgeom=False))
        yield f"{method} {element}", -pull(results, "cone", "force y"), exact, 0.06


@check(friction=True)
def hertz_contact_sheared_to_and_fro() -> Iterator[Row]:
    """Energy of partial slip: its slip is mu times the gap of Hertz at the stick zone c.

    Outside of a half width c the gap is c^2 / 2R (z sqrt(z^2 - 1) - arcosh z), z = x / c.
    Loading to Q loses 2 int_c^a mu p mu h dx, each reversal twice that.
    """
    E, nu, R, half, mu, share = 1e4, 0.49, 5.0, 1.0, 0.4, 0.6
    modulus = E / (1.0 - nu**2)
    P = math.pi * half**2 * modulus / (4.0 * R)
    c = half * math.sqrt(1.0 - share)

    def lost(x: float) -> float:
        z = x / c
        gap = c**2 / (2.0 * R) * (z * math.sqrt(z**2 - 1.0) - math.acosh(z))
        return 2.0 * P / (math.pi * half) * math.sqrt(1.0 - (x / half) ** 2) * mu**2 * gap

    exact = 2.0 * quad(lost, c, half)[0]
    for method, fine, pieces in variants((0.16, 0.08), (1, 4)):
        n = int(4.0 / fine)
        mesh = graded(20.0, 20.0, fine, n, n)
        ct.mesh.add_node(mesh, 0.0, R, "roll")
        model = ct.Model(mesh)
        model.section(
            "all",
            element="Q4",
            material=ct.Elastic(E=E, nu=nu),
            plane="strain",
            mean_dilatation=True,
        )
        model.fix("bottom")
        roll = ct.RigidCurve.circle((0.0, R), R, reference="roll")
        model.contact("top", roll, friction=mu, method=method, name="roll")
        press = ct.Static(nlgeom=False)
        press.fix("roll", x=0.0, y=None, rotation=True)
        press.force("roll", y=-P)
        steps = [press]
        for sign in (1.0, -1.0, 1.0):
            step = ct.Static(nlgeom=False, increments=pieces)
            if sign == 1.0 and len(steps) == 1:
                step.release("roll", y=False, rotation=False)
            step.force("roll", x=sign * share * mu * P)
            steps.append(step)
        results = ct.solve(model, steps)
        energy = results.history("friction energy")
        ends = [int(np.flatnonzero(results.history("step") == k)[-1]) for k in (1, 2, 3, 4)]
        name = f"{method} {fine} {pieces} increments"
        for k, factor in ((1, 1.0), (2, 2.0), (3, 2.0)):
            part = float(energy[ends[k]] - energy[ends[k - 1]])
            yield f"{name}, part {k}", part, factor * exact, 0.1


# --- metal and rubber -------------------------------------------------------------------------


@check(friction=True)
def metal_strip_between_rough_plates() -> Iterator[Row]:
    """Plane strain, w / h = 4: the friction hill, 2 k h / mu w (exp(mu w / h) - 1) in the mean."""
    k, w, h, mu = 100.0, 4.0, 1.0, 0.1
    exact = 2.0 * k * h / (mu * w) * (math.exp(mu * w / h) - 1.0)
    for method, n in variants((4, 8)):
        mesh = ct.mesh.rectangle(w / 2, h / 2, 4 * n, n)
        ct.mesh.add_node(mesh, 0.0, 2.0, "plate")
        model = ct.Model(mesh)
        metal = ct.Mises(E=1e5, nu=0.3, yield_stress=k * math.sqrt(3.0))
        model.section("all", element="Q4", material=metal, plane="strain", mean_dilatation=True)
        model.fix("left", y=None)
        model.fix("bottom", x=None)
        plate = ct.RigidCurve.line((6.0, h / 2), (-1.0, h / 2), reference="plate")
        model.contact("top", plate, friction=mu, method=method, name="plate")
        model.fix("plate", x=0.0, y=-0.01, rotation=True)
        results = ct.solve(model)
        press = -pull(results, "plate", "force y") / (w / 2)
        yield f"{method} {n}", press, exact, 0.03


@check(friction=True)
def cylinder_upset_with_friction() -> Iterator[Row]:
    """Mean pressure s (1 + 2 mu r / 3 h) of a slab of radius r and height h."""
    yields, r, h, mu = 200.0, 1.0, 1.0, 0.1
    exact = yields * (1.0 + 2.0 * mu * r / (3.0 * h))
    for method, n in variants((6, 12)):
        mesh = ct.mesh.rectangle(r, h / 2, 2 * n, n)
        ct.mesh.add_node(mesh, 0.0, 2.0, "plate")
        model = ct.Model(mesh)
        metal = ct.Mises(E=1e5, nu=0.3, yield_stress=yields)
        model.section(
            "all", element="Q4", material=metal, plane="axisymmetric", mean_dilatation=True
        )
        model.fix("bottom", x=None)
        plate = ct.RigidCurve.line((4.0, h / 2), (-1.0, h / 2), reference="plate")
        model.contact("top", plate, friction=mu, method=method, name="plate")
        model.fix("plate", x=0.0, y=-0.004)
        results = ct.solve(model)
        press = -pull(results, "plate", "force y") / (math.pi * r**2)
        yield f"{method} {n}", press, exact, 0.03


@check(friction=True)
def rubber_block_pressed_and_dragged() -> Iterator[Row]:
    """Smooth plates: the stretch of the law; with any friction to bond: the block held there."""
    for method, element, mu in variants(("Q4I", "Q8R"), (0.0, 1e6)):
        forces = []
        for bonded in (False, True):
            mesh = box(element, 2.0, 1.0, 8, 4)
            model = ct.Model(mesh)
            ct.mesh.add_node(mesh, 1.0, 3.0, "plate")
            rubber = ct.NeoHooke(C10=0.5, D1=0.02)
            model.section("all", element=element, material=rubber, plane="strain")
            if bonded:
                model.fix("bottom")
                model.fix("top", x=0.0, y=-0.15)
                results = ct.solve(model)
                forces.append(-last(results, "RF2", "top"))
                continue
            floor = ct.RigidCurve.line((-9.0, 0.0), (11.0, 0.0))
            plate = ct.RigidCurve.line((11.0, 1.0), (-9.0, 1.0), reference="plate")
            model.contact("bottom", floor, friction=mu, method=method, name="floor")
            model.contact("top", plate, friction=mu, method=method, name="plate")
            model.fix("plate", x=0.0, y=-0.15, rotation=True)
            if mu == 0.0:
                model.fix(np.flatnonzero(np.hypot(*(mesh.points - [1.0, 0.5]).T) < 1e-9), y=None)
            results = ct.solve(model)
            forces.append(-pull(results, "plate", "force y"))
        exact = forces[1] if mu else 2.0 * smooth_press(0.5, 0.02, 0.85)
        name = f"{method} {element} {'rough' if mu else 'smooth'}"
        yield name, forces[0], exact, 1e-3


def smooth_press(C10: float, D1: float, stretch: float) -> float:
    """Nominal pressure of a neo-Hookean block in plane strain with free sides."""

    def energy(side: float) -> float:
        J = side * stretch
        return C10 * ((side**2 + stretch**2 + 1.0) / J ** (2.0 / 3.0) - 3.0) + (J - 1.0) ** 2 / D1

    def slope(side: float) -> float:
        return (energy(side + 1e-6) - energy(side - 1e-6)) / 2e-6

    side = brentq(slope, 0.9 / stretch, 1.1 / stretch, xtol=1e-14)
    J = side * stretch
    first = (side**2 + stretch**2 + 1.0) * (-2.0 / 3.0) * J ** (-5.0 / 3.0) * side
    first += 2.0 * stretch / J ** (2.0 / 3.0)
    return -(C10 * first + 2.0 * (J - 1.0) * side / D1)


@check(friction=True)
def folded_strip_whose_arms_rub() -> Iterator[Row]:
    """Self-contact: two arms of one body, pressed together, slide at mu N."""
    mu = 0.3
    for method, element in variants(("Q4I", "Q8R")):
        arms = [box(element, 6.5, 0.5, 26, 5, (-2.5, y)) for y in (0.0, 0.6)]
        joint = ct.mesh.rectangle(0.5, 0.1, 2, 1, cell=CELLS[element], origin=(-2.5, 0.5))
        mesh = ct.mesh.merge(*arms, joint)
        center = np.array([mesh.points[c].mean(axis=0) for c in mesh.cells[0].nodes])
        # The arms end in a soft joint at the left of x = 0.
        mesh.cell_sets["soft"] = np.flatnonzero(center[:, 0] < 0.0)
        mesh.cell_sets["arms"] = np.flatnonzero(center[:, 0] > 0.0)
        model = ct.Model(mesh)
        model.section("arms", element=element, material=ct.Elastic(E=1e5, nu=0.3))
        model.section("soft", element=element, material=ct.Elastic(E=1e-3))
        sides = np.concatenate([mesh.edge_sets[name] for name in ("top", "bottom")])
        faces = sides[center[sides[:, 0], 0] > 0.0]
        model.contact(faces, faces, friction=mu, method=method, name="fold", reach=1.0)
        y = mesh.points[:, 1]
        model.fix(np.flatnonzero((y == 0.0) & (mesh.points[:, 0] >= 0.0)))
        top = np.flatnonzero(np.abs(y - 1.1) < 1e-9)
        top = top[mesh.points[top, 0] >= 0.0]
        close, draw = ct.Static(), ct.Static()
        close.fix(top, x=0.0, y=-0.1 - 1e-4)
        draw.fix(top, x=0.4, y=-0.1 - 1e-4)
        results = ct.solve(model, [close, draw])
        force = results.frames[-1].RF[top].sum(axis=0)
        yield f"{method} {element}", float(force[0] / -force[1]), mu, 0.01


@check(friction=True)
def stick_and_slip_on_a_path() -> Iterator[Row]:
    """A sprung block under displacement control: the load is mu P + k (u - mu P / K)."""
    for method, element in variants(("Q4I", "Q8")):
        model = sprung_block(element)
        floor = ct.RigidCurve.line((-2.0, 0.0), (8.0, 0.0))
        model.contact("bottom", floor, friction=0.3, method=method, name="floor")
        model.force("top", y=-10.0)
        press = ct.Static()
        step = ct.Static(path=ct.DisplacementControl("left", "x", 0.5))
        step.force("left", x=1.0)
        results = ct.solve(model, [press, step])
        factor = float(results.history("load factor")[-1])
        yield f"{method} {element}", factor, 3.0 + 20.0 * 0.5, 2e-3


@check(friction=True)
def load_factor_where_a_block_slides() -> Iterator[Row]:
    """Load control ends at mu P / F, and the message says that it slides."""
    for method, element, swapped in variants(("Q4I", "T6", "Q4D"), (False, True)):
        model = solids(
            element,
            table=box(element, 3.0, 0.5, 9, 2, (-1.0, -0.5)),
            block=box(element, 1.0, 0.4, 4, 2),
        )
        pair = ["block.bottom", "table.top"]
        if swapped:
            pair.reverse()
        model.contact(*pair, friction=0.25, method=method, name="joint")
        model.fix("table.bottom")
        model.force("block.top", y=-8.0)
        press, draw = ct.Static(), ct.Static()
        draw.force("block.left", x=5.0)
        held = largest_factor(model, [press, draw])
        yield f"{method} {element}{' swapped' if swapped else ''}", held * 5.0, 2.0, 5e-3


@check(friction=True)
def bolted_joint_opens_and_slips() -> Iterator[Row]:
    """A cooled bolt presses two plates: it opens at the preload, slips at mu times it."""
    E, area, cool, alpha = 1e5, 0.05, -100.0, 2e-5
    for method, element in variants(("Q4I", "Q8R")):
        lower = box(element, 1.0, 1.0, 4, 4)
        upper = box(element, 1.0, 1.0, 4, 4, (0.0, 1.0))
        bolt = ct.mesh.line([(0.5, 0.0), (0.5, 2.0)], n=1)
        mesh = ct.mesh.assembly(lower=lower, upper=upper, bolt=bolt)
        model = ct.Model(mesh)
        for plate in ("lower", "upper"):
            model.section(plate, element=element, material=ct.Elastic(E=E))
        model.truss("bolt", material=ct.Elastic(E=E, expansion=alpha), area=area)
        model.contact("upper.bottom", "lower.top", friction=0.2, method=method, name="joint")
        # Rigid heads: the outer faces move as one along y with the ends of the bolt.
        start, end = mesh.node_sets["bolt.start"][0], mesh.node_sets["bolt.end"][0]
        model.fix("lower.bottom")
        model.fix([start])
        for node in mesh.node_sets["upper.top"]:
            model.equation((int(node), "y", 1.0), (int(end), "y", -1.0))
        x = mesh.points[:, 0]
        model.fix([end], x=0.0, y=None)
        del x
        bolts = mesh.node_sets["bolt"]
        preload_step, work = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
        preload_step.temperature(cool, nodes=bolts)
        # Series of the bolt and the plates: alpha T L / (1 / k_b + 1 / k_p).
        k_bolt, k_plate = E * area / 2.0, E / 2.0
        preload = -alpha * cool * 2.0 / (1.0 / k_bolt + 1.0 / k_plate)
        for share, word in ((0.5, "closed"), (1.5, "open")):
            work = ct.Static(nlgeom=False)
            # Force that parts the heads, on that of the upper plate.
            total = preload * (k_bolt + k_plate) / k_plate * share
            work.force([int(end)], y=total)
            results = ct.solve(model, [preload_step, work])
            pressed = pull(results, "joint", "force y")
            exact = preload * (1.0 - share) if share < 1.0 else 0.0
            name = f"{method} {element} {word}"
            tolerance = 1e-3 if share < 1.0 else 1e-6 * preload
            yield name, pressed, exact, tolerance
        slip = ct.Static(nlgeom=False)
        slip.fix("upper.right", x=0.01, y=None)
        results = ct.solve(model, [preload_step, slip])
        pulled = last(results, "RF1", "upper.right")
        yield f"{method} {element} slips", pulled, 0.2 * pull(results, "joint", "force y"), 1e-3


@check(friction=True)
def layer_of_an_exponential_law() -> Iterator[Row]:
    """Dragged on a layer, a block sinks as the law says and needs mu P."""
    p0, c0, load = 2.0, 0.01, 12.0

    def law(w: float) -> float:
        z = w / c0 + 1.0
        return p0 / (math.e - 1.0) * z * (math.exp(z) - 1.0) - load

    sunk = brentq(law, -c0, 10.0 * c0)
    for method, element, swapped in variants(("Q4I", "Q8R"), (False, True)):
        model = solids(
            element,
            E=1e7,
            table=box(element, 3.0, 0.2, 12, 2, (-1.0, -0.2)),
            block=box(element, 1.0, 0.1, 5, 1),
        )
        pair = ["block.bottom", "table.top"]
        if swapped:
            pair.reverse()
        layer = ct.PressureLaw("exponential", [p0], [c0])
        model.contact(*pair, law=layer, friction=0.3, method=method, name="layer")
        model.fix("table.bottom")
        model.force("block.top", y=-load)
        press, draw = ct.Static(), ct.Static()
        press.fix("block.left", x=0.0, y=None)
        draw.fix("block.left", x=0.3, y=None)
        results = ct.solve(model, [press, draw])
        name = f"{method} {element}{' swapped' if swapped else ''}"
        yield f"{name} sunk", -last(results, "U2", "block.top", 1), sunk, 0.01
        yield f"{name} friction", last(results, "RF1", "block.left"), 0.3 * load, 5e-3


@check(friction=False)
def bimetal_strip_meets_a_stop() -> Iterator[Row]:
    """Tied layers bend by 1.5 da dT / h when heated; the stop at the tip has 3 EI (d - g) / L^3."""
    length, h, E, heat, gap = 20.0, 1.0, 1e5, 50.0, 0.1
    bend = 1.5 * 2e-5 * heat / h
    free = bend * length**2 / 2.0
    exact = 3.0 * E * h**3 / 12.0 * (free - gap) / length**3
    for method, element in variants(("Q8R", "Q4I")):
        meshes = {
            "lower": box(element, length, h / 2, 30, 1),
            "upper": box(element, length, h / 2, 40, 1, (0.0, h / 2)),
        }
        model = ct.Model(ct.mesh.assembly(**meshes))
        for part, expansion in (("lower", 0.0), ("upper", 2e-5)):
            model.section(part, element=element, material=ct.Elastic(E=E, expansion=expansion))
        model.tie("upper.bottom", "lower.top")
        stop = ct.RigidCurve.line((length - 3.0, -gap), (length + 3.0, -gap))
        model.contact("lower.bottom", stop, method=method, name="stop")
        model.fix(["lower.left", "upper.left"])
        model.temperature(heat)
        results = ct.solve(model, ct.Static(nlgeom=False))
        yield f"{method} {element}", pull(results, "stop", "force y"), exact, 0.02
