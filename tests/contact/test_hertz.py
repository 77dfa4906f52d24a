"""A roller on a block against Hertz's line contact (Konter's data)."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct

R, H, E1, E2, NU = 50.0, 100.0, 210e3, 70e3, 0.3


def graded(a, b):
    """Points from a to b, close together at a."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return lambda t: a + (b - a) * (np.asarray(t) ** 1.7)[..., None]


def roller(n, element, cell, plane, load, nlgeom):
    """A quarter of the roller on half of the block; the load is that of the whole."""

    def arc(t):
        angle = np.radians(60.0) * np.asarray(t) ** 1.7
        return np.stack([R * np.sin(angle), R - R * np.cos(angle)], axis=-1)

    end, corner = arc(1.0), (0.6 * R, R)
    disc = ct.mesh.mapped(
        [arc, graded(end, corner), graded((0, R), corner), graded((0, 0), (0, R))], n, n, cell
    )
    up = graded((0, 0), (0, -H))
    side = graded((H, 0), (H, -H))
    block = ct.mesh.mapped(
        [graded((0, -H), (H, -H)), lambda t: side(1.0 - np.asarray(t)), graded((0, 0), (H, 0)),
         lambda t: up(1.0 - np.asarray(t))], n, n, cell,
    )  # fmt: skip
    mesh = ct.mesh.assembly(disc=disc, block=block)
    model = ct.Model(mesh)
    for name, modulus in (("disc", E1), ("block", E2)):
        material = ct.Elastic(E=modulus, nu=NU)
        model.section(name, element=element, material=material, plane=plane)
        model.fix(f"{name}.left", x=0.0, y=None, rotation=True)
    model.fix("block.bottom", x=None, y=0.0)
    model.traction("disc.top", y=-0.5 * load / (0.6 * R))
    model.contact("disc.bottom", "block.top", name="roller")
    results = ct.solve(model, ct.Static(nlgeom=nlgeom), fields=False, threads=1)
    nodes = mesh.nodes_of("disc.bottom")
    return results, mesh.points[nodes, 0], results.nodal("CPRESS")[nodes]


def hertz(load, plane):
    c = 1.0 - NU**2 if plane == "strain" else 1.0
    modulus = 1.0 / (c / E1 + c / E2)
    a = np.sqrt(4.0 * load * R / (np.pi * modulus))
    return a, 2.0 * load / (np.pi * a)


@pytest.mark.parametrize(
    ("element", "cell", "plane", "nlgeom"),
    [
        ("Q8R", "quad8", "strain", False),
        ("Q8R", "quad8", "stress", False),
        ("Q4D", "quad4", "strain", True),
    ],
)
def test_peak_pressure_and_half_width(element, cell, plane, nlgeom):
    load = 35e3
    results, x, p = roller(20, element, cell, plane, load, nlgeom)
    # Peak of the ellipse p^2 = p0^2 (1 - x^2/a^2) through the pressures; a^2/4 is its second
    # moment.
    inner = p > 0.2 * p.max()
    ellipse = np.column_stack([np.ones(inner.sum()), x[inner] ** 2])
    square = np.linalg.lstsq(ellipse, p[inner] ** 2, rcond=None)[0][0]
    order = np.argsort(x)
    fine = np.linspace(0.0, x.max(), 20001)
    q = np.interp(fine, x[order], p[order])
    a, p0 = hertz(load, plane)
    assert np.sqrt(square) == pytest.approx(p0, rel=0.02)
    assert 2.0 * np.sqrt((q * fine**2).sum() / q.sum()) == pytest.approx(a, rel=0.02)
    frame = results.frames[-1]
    assert frame.scalars["roller: force y"] == pytest.approx(0.5 * load, rel=1e-9)
    assert frame.scalars["iterations"] <= 16
    assert results.info.get("cut-backs", 0) == 0


def test_the_reference_values():
    assert hertz(35e3, "strain") == pytest.approx((6.214627867, 3585.362231), rel=1e-9)
