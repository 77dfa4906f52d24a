"""Complex frequencies: loads that follow, damping, spin; and frequencies with ties and contact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from support.lines import lines

CELL = {"Q4": "quad4", "Q4I": "quad4", "Q4D": "quad4", "Q8": "quad8", "T6": "tri6", "OPT": "tri3"}


def modes_of(model, *, static=True, **keys):
    steps = [ct.Static()] if static else []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(model, [*steps, ct.Frequency(**keys)], threads=1, fields=False)
    return results.modes[-1], results


def beck(load, element="Q8", nx=16, **keys):
    """Cantilever of slenderness 40 under a tangential end force, in units of E I / L^2."""
    h, length, young = 0.25, 10.0, 1e4
    inertia = h**3 / 12.0
    model = ct.Model(ct.mesh.rectangle(length, h, nx=nx, ny=1, cell=CELL[element]))
    model.section("all", element=element, material=ct.Elastic(E=young, nu=0.0, rho=1.0))
    model.fix("left")
    model.pressure("right", load * young * inertia / length**2 / h)
    unit = np.sqrt(young * inertia / (h * length**4))
    modes, results = modes_of(model, modes=2, **keys)
    return 2.0 * np.pi * modes.factors / unit, modes.growth / unit, results


@pytest.mark.parametrize(("element", "nx"), [("Q8", 24), ("Q4I", 24), ("Q8", 60)])
def test_becks_column_flutters_above_its_critical_load(element, nx):
    """Beck 1952: frequencies meet at P = 20.05 EI / L^2, w = 11.016 sqrt(EI / mL^4).

    The second mesh has more unknowns than the dense solver takes. The column is a solid of
    slenderness 40: the two frequencies approach each other as a square root of the load.
    """
    below, growth, results = beck(19.95 if element == "Q8" else 19.5, element, nx)
    assert len(below) == 2
    assert (growth == 0.0).all()
    assert not [n for n in results.notes if "unstable" in n]
    above, growth, results = beck(20.2 if element == "Q8" else 20.6, element, nx)
    assert above[0] == pytest.approx(11.016, rel=0.02)
    assert growth[0] > 0.1
    assert any("flutter" in note for note in results.notes)


def test_beck_with_damping_is_found_in_state_space_too():
    plain, growth, _ = beck(25.0)
    also, more, results = beck(25.0, complex_modes=True)
    assert also[0] == pytest.approx(plain[0], rel=1e-8)
    assert more.max() == pytest.approx(growth[0], rel=1e-8)
    assert any("flutter" in note for note in results.notes)


@pytest.mark.parametrize("nx", [12, 60])
def test_a_dead_load_beyond_buckling_is_divergence(nx):
    """Euler's column at 1.5 times its load: the first mode grows as exp(t sqrt(-w^2))."""
    model = ct.Model(ct.mesh.rectangle(10.0, 0.25, nx=nx, ny=1, cell="quad8"))
    model.section("all", element="Q8", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.fix("left")
    critical = np.pi**2 * 1e4 * 0.25**3 / 12.0 / 400.0
    model.traction("right", x=-1.5 * critical / 0.25)
    modes, results = modes_of(model, modes=3)
    # Roots of the transcendental equation of a clamped-free beam under compression, P = 1.5 Pe.
    assert modes.factors[0] == 0.0
    assert modes.growth[0] > 0.0
    assert (modes.factors[1:] > 0.0).all()
    assert any("divergence" in note for note in results.notes)


@pytest.mark.parametrize("nx", [10, 60])
def test_rayleigh_damping_of_a_material_gives_the_decay_of_every_mode(nx):
    """s^2 + (a + b w^2) s + w^2 = 0 for each mode w."""
    a, b = 0.3, 2e-4
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=1, cell="quad8"))
    steel = ct.Elastic(E=1e4, nu=0.3, rho=1.0, rayleigh=(a, b))
    model.section("all", element="Q8", material=steel)
    model.fix("left")
    w = 2.0 * np.pi * modes_of(model, static=False, modes=4)[0].factors
    found, _ = modes_of(model, static=False, modes=4, complex_modes=True)
    c = a + b * w**2
    assert found.growth == pytest.approx(-0.5 * c, rel=1e-6)
    assert 2.0 * np.pi * found.factors == pytest.approx(np.sqrt(w**2 - 0.25 * c**2), rel=1e-6)


def test_a_dashpot_to_the_ground_makes_an_oscillator_decay():
    """Overdamped and underdamped: s = -c/2m +- sqrt(c^2/4m^2 - k/m)."""
    for c in (0.5, 6.0):
        mesh = lines([(0.0, 0.0), (1.0, 0.0)], ("line2", [[0, 1]]))
        model = ct.Model(mesh)
        model.spring([0], 4.0, "x")
        model.fix([0])
        model.fix([1], x=None, y=0.0)
        model.point_mass([1], 1.0)
        model.dashpot(1, x=c)
        found, _ = modes_of(model, static=False, modes=1, complex_modes=True)
        exact = np.roots([1.0, c, 4.0])
        slow = exact[np.argmin(np.abs(exact))]
        assert found.growth[0] == pytest.approx(slow.real, rel=1e-9)
        assert 2.0 * np.pi * found.factors[0] == pytest.approx(abs(slow.imag), abs=1e-9)


@pytest.mark.parametrize("element", ["Q4", "Q8", "T6", "Q4D", "OPT"])
@pytest.mark.parametrize("speed", [1.5, 5.0])
def test_an_isotropic_rotor_has_the_frequencies_of_forward_and_backward_whirl(element, speed):
    """A stiff block on equal springs, seen from the turning frame: |w0 - W| and w0 + W.

    Below and above its critical speed w0 = 2: isotropic rotors without damping stay stable.
    """
    base = ct.mesh.move(
        ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2, cell=CELL[element]), shift=(-0.5, -0.5)
    )
    corners = [
        int(np.argmin(np.hypot(*(base.points - p).T)))
        for p in ([-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5])
    ]
    label = base.n_cells
    points = np.repeat(corners, 2)[:, None]
    springs = Cells("point1", points, np.arange(label + 1, label + 9))
    mesh = Mesh(base.points, [*base.cells, springs], base.node_labels)
    model = ct.Model(mesh)
    solid = np.arange(label)
    model.section(solid, element=element, material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    model.spring(np.arange(label, label + 8, 2), 1.0, "x")
    model.spring(np.arange(label + 1, label + 8, 2), 1.0, "y")
    model.centrifugal(speed)
    found, _ = modes_of(model, modes=4, complex_modes=True)
    w = 2.0 * np.pi * found.factors
    for exact in (abs(2.0 - speed), 2.0 + speed):
        assert np.abs(w - exact).min() < 0.01 * exact


def split(kind):
    """A strip of two halves across its length, joined in several ways."""
    left = ct.mesh.rectangle(5.0, 0.5, 10, 2, "quad8")
    right = ct.mesh.rectangle(5.0, 0.5, 10, 2, "quad8", origin=(5.0, 0.0))
    if kind == "one":
        mesh = ct.mesh.merge(left, right)
        model = ct.Model(mesh)
        x = mesh.points[:, 0]
        model.section("all", element="Q8", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        model.fix(np.flatnonzero(x == 0.0))
        return model
    model = ct.Model(ct.mesh.assembly(left=left, right=right))
    model.section("all", element="Q8", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.fix("left.left")
    if kind == "tie":
        model.tie("right.left", "left.right")
    else:
        model.contact("right.left", "left.right", friction=0.3 if kind == "rough" else 0.0)
    return model


def test_a_tied_strip_vibrates_as_one_piece():
    one = modes_of(split("one"), static=False, modes=5)[0].factors
    tied = modes_of(split("tie"), static=False, modes=5)[0].factors
    assert tied == pytest.approx(one, rel=1e-6)


@pytest.mark.parametrize("kind", ["rough", "smooth"])
def test_closed_contact_holds_what_touches_and_open_contact_nothing(kind):
    """A strip pressed together: one piece if it sticks, else free to slide along the joint.

    Without friction the joint passes axial force and moment but no shear: the equations
    "same x on both sides" make the same model without contact.
    """
    model = split(kind)
    if kind == "smooth":
        model.fix("right.right", x=None, y=0.0)
    model.traction("right.right", x=-0.1)
    found = modes_of(model, modes=4)[0].factors
    other = split("one" if kind == "rough" else "tie")
    if kind == "smooth":
        other.ties.clear()
        mesh = other.mesh
        left, right = mesh.nodes_of("left.right"), mesh.nodes_of("right.left")
        left = left[np.argsort(mesh.points[left, 1])]
        right = right[np.argsort(mesh.points[right, 1])]
        for a, b in zip(left, right, strict=True):
            other.equation((int(b), "x", 1.0), (int(a), "x", -1.0))
        other.fix("right.right", x=None, y=0.0)
    same = modes_of(other, static=False, modes=4)[0].factors
    # The axial stress of 0.1 changes frequencies by a share of about 1e-3.
    assert found == pytest.approx(same, rel=2e-2)


def test_bodies_apart_vibrate_apart():
    model = split("smooth")
    model.contacts[0].clearance = 0.1
    model.fix("right.right")
    both = modes_of(model, static=False, modes=4)[0].factors
    alone = ct.Model(ct.mesh.rectangle(5.0, 0.5, 10, 2, "quad8"))
    alone.section("all", element="Q8", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    alone.fix("left")
    one = modes_of(alone, static=False, modes=2)[0].factors
    assert both == pytest.approx(np.repeat(one, 2), rel=1e-8)


def leipholz(load, nx=16):
    """Cantilever under a tangential force spread over its length, in units of E I / L^3.

    A pressure on the cross-section at the end of every element turns with it. The last one has
    half the weight.
    """
    h, length, young = 0.25, 10.0, 1e4
    inertia = h**3 / 12.0
    model = ct.Model(ct.mesh.rectangle(length, h, nx=nx, ny=1, cell="quad8"))
    model.section("all", element="Q8", material=ct.Elastic(E=young, nu=0.0, rho=1.0))
    model.fix("left")
    each = load * young * inertia / length**3 * (length / nx) / h
    start = model.mesh.points[model.mesh.cells[0].nodes[:, 0], 0]
    for k, cell in enumerate(np.argsort(start).tolist()):
        model.pressure(np.array([[cell, 1]]), each if k < nx - 1 else 0.5 * each)
    return modes_of(model, modes=2)


def test_leipholz_column_flutters_above_its_critical_load():
    """Leipholz 1962: flutter at q L^3 = 40.05 EI, the frequencies being those of the solid."""
    assert (leipholz(39.8)[0].growth == 0.0).all()
    modes, results = leipholz(40.5)
    assert modes.growth[0] > 0.0
    assert any("flutter" in note for note in results.notes)


def ziegler(load, damping=None):
    """Two rigid bars of length 1 on torsion springs of 1, masses 2 and 1, a following force."""
    h = 0.1
    corners = [(2.0, -h / 2), (2.0 + h, -h / 2), (2.0 + h, h / 2), (2.0, h / 2)]
    points = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (2.0, 0.0), *corners, (0.0, 0.0), (1.0, 0.0)]
    mesh = lines(
        points[: 9 if damping is None else 10],
        ("line2", [[0, 1], [2, 3], [1, 2], [8, 0]]),
        ("quad4", [[4, 5, 6, 7]]),
    )
    model = ct.Model(mesh)
    light = ct.Elastic(E=1e6, nu=0.0, rho=1e-9)
    model.beam([0, 1], material=light, area=1.0, inertia=1.0)
    model.spring([2, 3], 1.0, "rotation")
    model.section([4], element="Q4", material=light)
    for dof in ("x", "y"):
        model.equation((2, dof, 1.0), (1, dof, -1.0))
    model.rigid([4, 5, 6, 7], 3)
    model.fix([0])
    model.fix([8], rotation=True)
    model.point_mass([1], 2.0)
    model.point_mass([3], 1.0)
    model.pressure(np.array([[4, 1]]), load / h)
    if damping is None:
        return modes_of(model, modes=2)
    # A dashpot turns against the ground: a node of its own has the angle of the second joint.
    model.equation((9, "rotation", 1.0), (2, "rotation", -1.0), (1, "rotation", 1.0))
    model.dashpot(0, rotation=damping)
    model.dashpot(9, rotation=damping)
    return modes_of(model, modes=2, complex_modes=True)


def test_zieglers_double_pendulum_flutters_above_its_critical_load():
    """Ziegler 1952: P = 7/2 - sqrt(2) = 2.086 without damping."""
    modes, _ = ziegler(0.0)
    exact = np.sqrt(0.5 * (7.0 - np.sqrt(41.0)) / 2.0), np.sqrt(0.5 * (7.0 + np.sqrt(41.0)) / 2.0)
    assert 2.0 * np.pi * modes.factors == pytest.approx(exact, rel=1e-4)
    assert (ziegler(2.08)[0].growth == 0.0).all()
    modes, results = ziegler(2.09)
    assert modes.growth[0] > 0.0
    assert any("flutter" in note for note in results.notes)


def test_damping_destabilizes_zieglers_pendulum():
    """Ziegler's paradox: with a little equal damping in both joints P = 41/28 = 1.464."""
    assert ziegler(1.44, 1e-3)[0].growth.max() <= 0.0
    modes, results = ziegler(1.49, 1e-3)
    assert modes.growth.max() > 0.0
    assert any("flutter" in note for note in results.notes)


#: Frequencies of CalculiX 2.20: strip 1 x 0.02 of 30 CPS8, E = 1e6, clamped, density 1; a static
#: step with NLGEOM, then *STEP, PERTURBATION and *FREQUENCY.
CALCULIX = {
    "spinning": [4.103298, 25.24933, 62.40098, 116.8798],
    "pulled": [11.53378, 38.80567, 77.81643, 132.5552],
}


@pytest.mark.parametrize("kind", CALCULIX)
def test_preloaded_strips_vibrate_as_in_calculix(kind):
    """At twice its first frequency as angular velocity, and under a tension of 30."""
    model = ct.Model(ct.mesh.rectangle(1.0, 0.02, 30, 1, "quad8"))
    model.mesh.points[:, 1] -= 0.01
    model.section("all", element="Q8", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.fix("left")
    if kind == "spinning":
        model.centrifugal(2.0 * 3.516015 * np.sqrt(1e6 * 0.02**3 / 12.0 / 0.02))
    else:
        model.force(model.mesh.nodes_of("right"), x=10.0)
    found = modes_of(model, modes=4)[0].factors
    # CalculiX' CPS8 are solids whose middle plane stays plane: shear makes .3 % at this mesh.
    assert found == pytest.approx(CALCULIX[kind], rel=4e-3)


def taut_particle(beta):
    """A particle between two taut bars: across them all of its stiffness is that of their tension.

    Unit lengths and areas, E = 100, tension 2, mass 0.5.
    """
    mesh = lines([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], ("line2", [[0, 1], [1, 2]]))
    model = ct.Model(mesh)
    wire = ct.Elastic(E=100.0, rho=1e-9, rayleigh=(0.0, beta))
    model.truss([0, 1], material=wire, area=1.0)
    model.initial_stress("", xx=2.0)
    model.point_mass([1], 0.5)
    model.fix([0, 2])
    return model


def test_tension_dissipates_nothing_in_complex_modes():
    """Rayleigh damping is that of the elastic stiffness alone, as in direct integration.

    Across, k = 2 N / L = 4 and c = 0; along, k = 2 E A / L = 200 and c = beta k.
    """
    beta = 0.01
    modes = ct.solve(taut_particle(beta), ct.Frequency(modes=2, complex_modes=True)).modes[-1]
    along = np.roots([0.5, 200.0 * beta, 200.0])
    assert modes.growth == pytest.approx([0.0, along.real[0]], rel=1e-6, abs=1e-9)
    w = [np.sqrt(8.0), abs(along.imag[0])]
    assert 2.0 * np.pi * modes.factors == pytest.approx(w, rel=1e-6)


@pytest.mark.parametrize("kind", ["modal", "direct", "harmonic"])
def test_tension_dissipates_nothing_in_responses(kind):
    """The particle swings across its wires without decay, in every linear and nonlinear motion."""
    model, w, beta = taut_particle(0.0), np.sqrt(8.0), 0.05
    if kind == "harmonic":
        step = ct.SteadyState(lowest=1.0, highest=2.0, points=2, direct=True, rayleigh=(0.0, beta))
        step.force([1], y=1.0)
        frame = ct.solve(model, step).frames[-1]
        assert frame.U[1, 1] == pytest.approx(1.0 / (4.0 - 0.5 * (4.0 * np.pi) ** 2), rel=1e-6)
        assert abs(frame.V[1, 1]) < 1e-9
        return
    model.velocity([1], y=1e-4)
    end = 10.0 * 2.0 * np.pi / w
    keys = {"period": end, "increments": 2000, "rayleigh": (0.0, beta)}
    if kind == "modal":
        steps = [ct.Frequency(modes=2), ct.ModalDynamic(**keys)]
    else:
        steps = [ct.Dynamic(scheme="newmark", **keys)]
    frame = ct.solve(model, steps).frames[-1]
    assert frame.V[1, 1] == pytest.approx(1e-4, rel=1e-3)
