"""Both contact methods on problems with known answers, with default increments.

One of them is the default: it must be right on all. `--write` puts the table into docs/contact.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.common import table
from benchmarks.contact_case_models import METHODS
from benchmarks.contact_sawtooth import jagged
from corota.errors import ConvergenceError, CorotaError
from corota.verification.contact_models import ellipse_of
from corota.verification.problems import contact_patch
from corota.verification.problems.konter_roller import hertz, pressures, roller

if TYPE_CHECKING:
    from collections.abc import Callable

#: Friction and the way of the dragged block, in widths of the block.
FRICTION, WAY = 0.2, 0.37


def patch(method: str, element: str) -> tuple[float, float]:
    """Largest error of a uniform stress between meshes that do not match, over the pressure."""
    results = contact_patch.solved(element, element, 0.0, method=method)
    across = contact_patch.stresses(results, 0.0)[:, 1]
    return float(np.ptp(across)) / contact_patch.PRESSURE, 0.0


def tipping(method: str, n: int, slave: str) -> tuple[float, float]:
    """Inclination at which a block of width .5 and height 1 tips."""
    block = ct.mesh.rectangle(0.5, 1.0, n, 2 * n)
    table_ = ct.mesh.rectangle(3.0, 0.5, 11, 2, origin=(-1.03, -0.5))
    mesh = ct.mesh.assembly(block=block, table=table_)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    model.fix("table.bottom")
    pair = ["block.bottom", "table.top"]
    model.contact(*(pair if slave == "block" else pair[::-1]), friction=0.9, method=method)
    weight, tilt = ct.Static(name="weight"), ct.Static(name="tilt")
    weight.gravity(y=-1.0, cells="block")
    tilt.gravity(x=1.0, cells="block")
    try:
        frame = ct.solve(model, [weight, tilt]).frames[-1]
    except ConvergenceError as error:
        frame = error.results.frames[-1]
    return (float(frame.step_time) if frame.step == 2 else 0.0), 0.5


def ring(method: str, element: str) -> tuple[float, float]:
    """Force of a slender ring squeezed between plates."""
    radius, t, young, squeeze = 10.0, 0.4, 1e5, 0.05
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.annulus(radius - t / 2, radius + t / 2, 2, 80, cell=cell)
    plate = ct.mesh.add_node(mesh, 0.0, 12.0, "plate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=young, nu=0.0))
    top = radius + t / 2
    upper = ct.RigidCurve.line((30.0, top), (-30.0, top), reference=plate)
    model.contact("outer", upper, friction=0.3, method=method, name="upper")
    lower = ct.RigidCurve.line((-30.0, -top), (30.0, -top))
    model.contact("outer", lower, friction=0.3, method=method, name="lower")
    model.fix("plate", x=0.0, y=-squeeze, rotation=True)
    frame = ct.solve(model, ct.Static()).frames[-1]
    force = squeeze * young * t**3 / 12.0 / (0.14878 * radius**3)
    return -frame.scalars["upper: force y"], force


def peak(method: str, element: str, n: int) -> tuple[float, float]:
    """Peak pressure of a roller on a block, n cells to the side."""
    results = roller(n, element, "strain", method=method)
    return ellipse_of(*pressures(results))[1], hertz(35e3, "strain")[1]


def dragged(method: str, slave: str) -> tuple[float, float]:
    """Friction over pressure of a block dragged over a wider table in one increment."""
    block = ct.mesh.rectangle(1.0, 0.5, 5, 3, origin=(0.13, 0.5))
    table_ = ct.mesh.rectangle(3.0, 0.5, 11, 2)
    mesh = ct.mesh.assembly(block=block, table=table_)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("table.bottom")
    pair = ["block.bottom", "table.top"]
    model.contact(
        *(pair if slave == "block" else pair[::-1]), friction=FRICTION, method=method, name="pair"
    )
    press, drag = ct.Static(name="press"), ct.Static(name="drag")
    press.fix("block.top", x=0.0, y=-0.01)
    drag.fix("block.top", x=WAY, y=-0.01)
    frame = ct.solve(model, [press, drag]).frames[-1]
    at = frame.scalars
    return abs(at["pair: force x"] / at["pair: force y"]), FRICTION


def stacked(method: str) -> tuple[float, float]:
    """Force on the second block of four that overhang by 80 % of the most that stands."""
    part, length, height, count = 0.8, 1.0, 0.25, 4
    places = np.cumsum([0.0] + [part * length / (2.0 * (count - i)) for i in range(1, count)])
    blocks = {
        f"b{i}": ct.mesh.rectangle(length, height, 8, 2, origin=(x, i * height))
        for i, x in enumerate(places)
    }
    mesh = ct.mesh.assembly(**blocks)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.fix("b0.bottom")
    for i in range(1, count):
        model.contact(
            f"b{i}.bottom", f"b{i - 1}.top", friction=0.5, method=method, name=f"joint {i}"
        )
    step = ct.Static()
    step.gravity(y=-1.0)
    frame = ct.solve(model, step).frames[-1]
    return frame.scalars["joint 1: force y"], (count - 1) * length * height


CASES: list[tuple[str, Callable[..., tuple[float, float]], tuple[Any, ...]]] = [
    ("patch test, Q4I: spread of the stress over the pressure", patch, ("Q4I",)),
    ("patch test, Q8R", patch, ("Q8R",)),
    *((f"tipping, {n} elements", tipping, (n, "block")) for n in (1, 2, 4)),
    *((f"tipping, {n} elements, table as slave", tipping, (n, "table")) for n in (1, 2, 4)),
    ("stack at 80 % of its limit", stacked, ()),
    *((f"ring between plates, {e}", ring, (e,)) for e in ("Q4I", "Q4D", "Q8R")),
    *(
        (f"peak pressure, {e}, {n} x {n}", peak, (e, n))
        for e in ("Q4I", "Q8R")
        for n in (10, 20, 40)
    ),
    ("friction of a dragged block", dragged, ("block",)),
    ("friction of a dragged block, table as slave", dragged, ("table",)),
    ("catch: departure from a smooth force", lambda method: (jagged(method, True)[0], 0.0), ()),
]


def main() -> int:
    """Command line."""
    rows = []
    for name, case, arguments in CASES:
        values, exact = [], ""
        for method in METHODS:
            try:
                value, reference = case(method, *arguments)
                values.append(f"{value:.4g}")
                exact = f"{reference:.4g}"
            except CorotaError as error:
                values.append(f"stops: {str(error)[:60]}")
        rows.append([name, exact, *values])
        sys.stderr.write(" | ".join(rows[-1]) + "\n")
    sys.stdout.write(f"{table(['problem', 'exact', *METHODS], rows)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
