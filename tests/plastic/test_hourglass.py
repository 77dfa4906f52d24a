"""Q4R beyond yield: its hourglass in the energy balance, and in what is linear about a state."""

# SPDX-License-Identifier: BSD-3-Clause

import numpy as np
import pytest

import corota as ct

STEEL = ct.Mises(E=1000.0, nu=0.3, yield_stress=4.0, isotropic=50.0, rho=1.0)


def strip(element="Q4R", material=STEEL, ny=2, **options):
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=ny))
    model.section("all", element=element, material=material, **options)
    model.fix("left")
    return model


def bent(model, increments, heat=None):
    """The strip bent beyond yield and back; optionally heated while it is bent."""
    down, held, back = (ct.Static(increments=increments, fixed_increments=True) for _ in range(3))
    down.fix("right", x=None, y=-0.4)
    if heat is not None:
        held.temperature(heat)
    back.fix("right", x=None, y=0.0)
    return ct.solve(model, [down, held, back])


@pytest.mark.parametrize(
    ("ny", "options"), [(1, {}), (2, {"plane": "strain", "local_strain": "logarithmic"})]
)
def test_flow_of_the_hourglass_dissipates(ny, options):
    """The energy error falls with the increment: all that is not stored is in ALLPD."""
    errors = []
    for n in (20, 80):
        frame = bent(strip(ny=ny, **options), n).frames[-1]
        errors.append(abs(frame.scalars["energy balance error"]))
    assert errors[1] < 2e-3
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize("element", ["Q4R", "Q4D"])
def test_moduli_that_follow_the_temperature_change_energies_beside_the_points(element):
    """A bent elastic strip loses 60 % of its energy as its modulus falls by 60 %."""
    table = [(0.0, ct.Elastic(E=1000.0, nu=0.3)), (100.0, ct.Elastic(E=400.0, nu=0.3))]
    model = strip(element, ct.MaterialTable(table), ny=1)
    scalars = [f.scalars for f in bent(model, 40, heat=100.0).frames]
    bending, heating = (s["ALLSE"] + s["ALLAE"] for s in (scalars[40], scalars[80]))
    assert heating == pytest.approx(0.4 * bending, rel=1e-6)
    got = scalars[80]["ALLTH"] - scalars[40]["ALLTH"]
    assert got == pytest.approx(-0.6 * bending, rel=5e-4)


def test_flow_and_moduli_that_follow_the_temperature():
    cold = ct.Mises(E=1000.0, nu=0.3, yield_stress=4.0, isotropic=50.0)
    hot = ct.Mises(E=500.0, nu=0.3, yield_stress=2.0, isotropic=20.0)
    material = ct.MaterialTable([(0.0, cold), (100.0, hot)])
    errors = [
        abs(bent(strip(material=material), n, heat=60.0).frames[-1].scalars["energy balance error"])
        for n in (20, 80)
    ]
    assert errors[1] < 5e-3
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize("traction", [2.0, 4.5, -4.5])
def test_vibration_about_flow_is_elastic(traction):
    """Small motions about a state that flows unload it in part: the points answer elastically.

    Q4R on rectangles is Q4I, also in the frequencies about a state of uniform flow. What follows
    the frequency step is not changed by it.
    """
    pulled = ct.Static(increments=4, nlgeom=False)
    pulled.traction("right", x=traction)
    found = []
    for element in ("Q4I", "Q4R"):
        model = ct.Model(ct.mesh.rectangle(4.0, 0.2, nx=16, ny=1))
        model.section("all", element=element, material=STEEL)
        model.fix("left", y=None)
        model.fix([0])
        steps = [pulled, ct.Frequency(modes=4, nlgeom=False)]
        found.append(ct.solve(model, steps).modes[-1].factors)
    assert found[1] == pytest.approx(found[0], rel=1e-8)


def test_a_frequency_step_leaves_the_hourglass_as_it_was():
    def run(*between):
        pulled, bent = ct.Static(increments=4), ct.Static(increments=4)
        pulled.fix("right", x=0.05, y=None)
        bent.fix("right", x=0.05, y=-0.1)
        return ct.solve(strip(), [pulled, *between, bent]).frames[-1]

    assert np.abs(run().U - run(ct.Frequency(modes=1)).U).max() < 1e-11
