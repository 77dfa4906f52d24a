"""Spinning blades: load at current positions, softening and stiffening, frequencies.

The class of defect: a rotational body load that does not follow the deformed body.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.steps import Frequency, Static
from support.models import cell

E, H = 1e6, 0.02
#: Bending stiffness, lowest circular frequency at rest (first root squared 3.51602).
EI = E * H**3 / 12.0
OMEGA = 3.516015 * np.sqrt(EI / H)


def blade(element: str, n: int = 40, angle: float = 0.0, rho: float = 1.0) -> ct.Model:
    """A blade of unit length and mass per area, clamped at the axis."""
    mesh = ct.mesh.rectangle(1.0, H, n, 1, cell(element))
    mesh.points[:, 1] -= H / 2.0
    c, s = np.cos(angle), np.sin(angle)
    mesh.points[:] = mesh.points @ np.array([[c, s], [-s, c]])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E, 0.0, rho=rho))
    model.fix("left", rotation=True)
    return model


def beam(ratio: float, force: float = 0.0, offset: float = 0.0) -> float:
    """Tip deflection of a slender blade under tension, by cubic elements of the beam equation.

    ``EI v_xxxx - (T v_x)_x - m w^2 v = m w^2 offset`` with ``T = m w^2 (1 - x^2) / 2`` and a
    force at the tip: a blade along x whose axis lies `offset` beside it.
    """
    n, m, w2 = 100, H, (ratio * OMEGA) ** 2
    h = 1.0 / n
    k, f = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros(2 * n + 2)
    points, weights = np.polynomial.legendre.leggauss(4)
    for e in range(n):
        dofs = slice(2 * e, 2 * e + 4)
        for g, w in zip(0.5 * (points + 1.0), 0.5 * h * weights, strict=True):
            shape = np.array(
                [
                    1 - 3 * g**2 + 2 * g**3,
                    h * (g - 2 * g**2 + g**3),
                    3 * g**2 - 2 * g**3,
                    h * (g**3 - g**2),
                ]
            )
            slope = (
                np.array(
                    [
                        -6 * g + 6 * g**2,
                        h * (1 - 4 * g + 3 * g**2),
                        6 * g - 6 * g**2,
                        h * (3 * g**2 - 2 * g),
                    ]
                )
                / h
            )
            bend = np.array([-6 + 12 * g, h * (-4 + 6 * g), 6 - 12 * g, h * (6 * g - 2)]) / h**2
            tension = m * w2 * (1.0 - ((e + g) * h) ** 2) / 2.0
            k[dofs, dofs] += w * EI * np.outer(bend, bend)
            k[dofs, dofs] += w * (
                tension * np.outer(slope, slope) - m * w2 * np.outer(shape, shape)
            )
            f[dofs] += w * m * w2 * offset * shape
    f[-2] += force
    return float(np.linalg.solve(k[2:, 2:], f[2:])[-2])


@pytest.mark.parametrize("element", ["Q8R", "Q9", "Q4I", "Q4D"])
@pytest.mark.parametrize(("ratio", "tip"), [(1.0, 0.00829), (2.0, 0.00582), (4.0, 0.00320)])
def test_tip_of_a_spinning_blade_under_a_transverse_force(
    element: str, ratio: float, tip: float
) -> None:
    """Beam equation, and CalculiX 2.20 (CPE8R 40 x 1), whose figures change by .5 % with its
    tolerance; .00460, .00180, .00056 with the load at reference positions."""
    force = 3.0 * EI * 0.01
    model = blade(element)
    model.force([_tip(model)], y=force)
    model.centrifugal(ratio * OMEGA)
    frame = ct.solve(model, Static(increments=4)).frames[-1]
    found = frame.U[_tip(model), 1]
    assert found == pytest.approx(tip, rel=1.2e-2)
    # At ratio 4 the blade has grown by .2 %.
    assert found == pytest.approx(beam(ratio, force=force), rel=8e-3)


def _tip(model: ct.Model) -> int:
    return int(np.argmin(np.hypot(*(model.mesh.points - [1.0, -H / 2.0]).T)))


@pytest.mark.filterwarnings("ignore:local strain")
@pytest.mark.parametrize("element", ["Q8R", "Q4D", "OPT"])
def test_a_bar_that_was_turned_pulls_along_its_new_direction(element: str) -> None:
    """Reaction m omega^2 r_c at 60 degrees: (-1.25, -.433) for the clamp that turned about its
    own middle; the axis lies one length behind, so r_c = (1, 0) + .5 (cos 60, sin 60)."""
    mesh = ct.mesh.rectangle(1.0, 0.1, 8, 2, cell(element))
    mesh.points[:, 1] -= 0.05
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(1e6, 0.0, rho=10.0))
    x, angle = mesh.points, np.pi / 3.0
    c, s = np.cos(angle), np.sin(angle)
    if element in ("Q4D", "OPT"):
        model.fix("left", x=None, y=None, rotation=angle)
    for node in mesh.nodes_of("left"):
        to = np.array([[c, -s], [s, c]]) @ x[node]
        model.fix([int(node)], x=to[0] - x[node, 0], y=to[1] - x[node, 1])
    spin = ct.Model(mesh)
    spin.centrifugal(1.0, about=(-1.0, 0.0))
    steps = [Static(increments=6), Static(loads=spin.loads)]
    frame = ct.solve(model, steps).frames[-1]
    found = frame.RF[mesh.nodes_of("left"), :2].sum(axis=0)
    assert found == pytest.approx([-1.25, -np.sqrt(3.0) / 4.0], rel=1e-3)


#: Flapping of a rotating cantilever, hub radius 0: Wright, Smith, Thresher and Wang, J. Appl.
#: Mech. 49 (1982) 197-202; speed and the first two frequencies, over sqrt(EI / m L^4).
FLAPPING = [(0.0, 3.5160, 22.0345), (3.0, 4.7973, 23.3203), (6.0, 7.3604, 26.8091),
            (12.0, 13.1702, 37.6031)]  # fmt: skip


@pytest.mark.parametrize("element", ["Q8R", "Q4D"])
@pytest.mark.parametrize("row", FLAPPING, ids=lambda row: f"{row[0]:g}")
def test_frequencies_of_a_rotating_cantilever_in_its_plane(
    element: str, row: tuple[float, float, float]
) -> None:
    """In the plane of rotation the frame softens: omega^2 = flapping^2 - Omega^2.

    Coriolis forces couple bending to stretching only: of the order of the slenderness squared.
    """
    speed, *flapping = row
    unit = np.sqrt(EI / H)
    model = blade(element)
    model.centrifugal(speed * unit)
    found = ct.solve(model, [Static(), Frequency(modes=2)]).modes[0].factors
    exact = np.sqrt(np.array(flapping) ** 2 - speed**2) * unit / (2.0 * np.pi)
    assert found == pytest.approx(exact, rel=4e-3)


def test_a_linear_preload_softens_and_stiffens() -> None:
    """A linear static step before the frequencies, as of ``*STEP, PERTURBATION``."""
    model = blade("Q8R")
    model.centrifugal(6.0 * np.sqrt(EI / H))
    found = ct.solve(model, [Static(nlgeom=False), Frequency(modes=2)]).modes[0].factors
    exact = np.sqrt(np.array(FLAPPING[2][1:]) ** 2 - 36.0) * np.sqrt(EI / H) / (2.0 * np.pi)
    assert found == pytest.approx(exact, rel=4e-3)


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_two_spins_on_two_sets_soften_their_own_mass_only(mass: str) -> None:
    """The same modes as one load on all; twice the softening before."""
    found = []
    for parts in ([np.arange(40)], [np.arange(25), np.arange(25, 40)]):
        model = blade("Q8R")
        for cells in parts:
            model.centrifugal(OMEGA, about=(-0.3, 0.0), cells=cells)
        steps = [Static(), Frequency(modes=3, mass=mass)]
        found.append(ct.solve(model, steps).modes[0].factors)
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_a_spin_on_a_part_softens_that_part_only() -> None:
    """Two blades of which one spins have the modes of a blade that spins and of one at rest."""
    found = []
    for spins in (True, False):
        model = blade("Q8R")
        if spins:
            model.centrifugal(OMEGA)
        steps = [Static(), Frequency(modes=2)] if spins else [Frequency(modes=2)]
        found += ct.solve(model, steps).modes[0].factors.tolist()
    one = blade("Q8R").mesh
    mesh = ct.mesh.assembly(one=one, other=ct.mesh.move(one, (0.0, 1.0)))
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(E, 0.0, rho=1.0))
    model.fix("one.left")
    model.fix("other.left")
    model.centrifugal(OMEGA, cells="one")
    both = ct.solve(model, [Static(), Frequency(modes=4)]).modes[0].factors
    assert both == pytest.approx(np.sort(found), rel=1e-8)


def test_the_axis_may_lie_off_the_blade() -> None:
    """The pull sideways by m omega^2 (d + v) against the beam equation."""
    model = blade("Q8R")
    model.centrifugal(2.0 * OMEGA, about=(0.0, -0.01))
    frame = ct.solve(model, Static(increments=4)).frames[-1]
    assert frame.U[_tip(model), 1] == pytest.approx(beam(2.0, offset=0.01), rel=5e-3)
