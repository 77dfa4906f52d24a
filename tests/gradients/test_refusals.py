"""What has no gradient is refused, with the reason."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota import gradients


def beam(step: ct.Static | None = None, law: object = None) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=2))
    model.section("all", element="Q4I", material=law or ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.fix("left")
    model.steps = [step or ct.Static()]
    return model


TIP = gradients.Displacement("right", "y")
MODULUS = gradients.Constant("E")


def refused(model: ct.Model, measure: gradients.Measure, wrt: object, why: str) -> None:
    results = ct.solve(model, threads=1)
    with pytest.raises(ct.UnsupportedError, match=why):
        ct.gradient(results, measure, wrt)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"scheme": "energy_momentum"}, "energy_momentum"),
        ({"rayleigh": (0.0, 1e-3)}, "damping per stiffness"),
    ],
)
def test_dynamics(options: dict[str, object], why: str) -> None:
    model = beam(ct.Dynamic(period=0.1, increments=2, **options))
    model.force("right", y=-0.1)
    refused(model, TIP, MODULUS, why)


def test_dynamics_after_statics_and_of_turning_masses() -> None:
    model = beam(ct.Static())
    model.force("right", y=-0.1)
    model.steps.append(ct.Dynamic(period=0.1, increments=2))
    refused(model, TIP, MODULUS, "beside other steps")
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=2))
    model.section("all", element="Q4D", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.fix("left")
    model.force("right", y=-0.1)
    model.steps = [ct.Dynamic(period=0.1, increments=2)]
    refused(model, TIP, MODULUS, "mass='constant'")


def test_what_bodies_do_not_have() -> None:
    """A solid of revolution has no thickness, and no area that its volume gives."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2, origin=(1.0, 0.0)))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3), plane="axisymmetric")
    model.fix("bottom")
    model.force("top", y=-1.0)
    refused(model, gradients.Displacement("top", "y"), gradients.Thickness(), "no thickness")
    with pytest.raises(ct.UnsupportedError, match="Mass"):
        ct.gradient(ct.solve(model, threads=1), gradients.Area(), MODULUS)


@pytest.mark.parametrize("element", ["Q4R", "OPT"])
@pytest.mark.parametrize("by", ["node", "section"])
def test_slopes_of_a_thickness(element: str, by: str) -> None:
    """The slopes of the thickness act on these elements: .059 for .086 without them (Q4R)."""
    cell = "tri3" if element == "OPT" else "quad4"
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2, cell=cell))
    across = 1.0 + (by == "section") * 0.1 * model.mesh.points[:, 1]
    law = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element=element, material=law, thickness=across)
    model.fix("left")
    model.force(model.mesh.node_sets["right"], y=-0.1)
    model.steps = [ct.Static()]
    refused(model, TIP, gradients.Thickness(by), element)


def test_velocity_of_a_static_step() -> None:
    model = beam()
    model.force("right", y=-0.1)
    results = ct.solve(model, threads=1)
    with pytest.raises(ct.InputError, match="dynamic step"):
        ct.gradient(results, gradients.Velocity("right", "y"), MODULUS)


def test_python_materials() -> None:
    moduli = np.diag([1000.0, 1000.0, 500.0])

    def hooke(strain: np.ndarray, state: np.ndarray, plane: str) -> tuple[np.ndarray, ...]:
        return strain @ moduli, np.broadcast_to(moduli, (*strain.shape, 3)), state

    model = beam(law=ct.UserMaterial(hooke))
    model.force("right", y=-0.1)
    refused(model, TIP, gradients.Thickness(), "materials in Python")


def test_loads_that_depend_on_positions() -> None:
    model = beam()
    model.pressure("top", 0.01)
    refused(model, TIP, gradients.Positions(), "gradients.Shape")
    refused(model, TIP, gradients.Thickness(), "gradients.Attribute")


def test_energy_of_what_flows_and_measures_that_see_the_parameter() -> None:
    model = beam(law=ct.Mises(1000.0, 0.3, yield_stress=1.0, isotropic=50.0))
    model.force("right", y=-0.05)
    refused(model, gradients.StrainEnergy(), MODULUS, "part of the work")
    model = beam()
    model.force(model.mesh.node_sets["right"], y=-0.1)
    refused(model, gradients.Mass(), gradients.Thickness(), "itself")


def test_load_factor_by_load_control_and_between_arcs() -> None:
    model = beam()
    model.force("right", y=-0.1)
    refused(model, gradients.LoadFactor(), MODULUS, "given")
    model = beam(ct.Static(path=ct.ArcLength(factor=1.0)))
    model.force("right", y=-1.0)
    refused(model, gradients.Displacement("right", "y", frame=1), MODULUS, "arc length")


def test_bifurcation_by_an_imperfection() -> None:
    """The mesh's third row of nodes moves: the column is not symmetric any more."""
    model = ct.Model(ct.mesh.rectangle(20.0, 1.0, nx=20, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("left")
    model.force("right", x=-10.0)
    model.steps = [ct.Static(path=ct.ArcLength(factor=0.8))]
    points = model.mesh.points
    bow = np.zeros((2, *points.shape))
    bow[0, :, 1] = np.sin(points[:, 0] / 10.0)
    bow[1, :, 0] = points[:, 0]
    refused(model, gradients.BifurcationLoad(), gradients.Shape(bow[:1]), "symmetry")
    results = ct.solve(model, threads=1)
    longer = ct.gradient(results, gradients.BifurcationLoad(), gradients.Shape(bow[1:]))
    load = results.critical_points[0].factor
    assert longer[0] / load == pytest.approx(-2.0, abs=0.02)


def test_double_frequencies() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=4, ny=4))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    for side in ("left", "right", "bottom", "top"):
        model.fix(side)
    model.steps = [ct.Frequency(modes=3)]
    refused(model, gradients.Frequency(0), MODULUS, "double")


def test_frames_that_were_not_kept() -> None:
    model = beam()
    model.force("right", y=-0.1)
    results = ct.solve(model, threads=1, keep="last")
    with pytest.raises(ct.InputError, match="keep='all'"):
        ct.gradient(results, TIP, MODULUS)


def test_reaction_where_nothing_is_fixed() -> None:
    model = beam()
    model.force("right", y=-0.1)
    results = ct.solve(model, threads=1)
    with pytest.raises(ct.InputError, match="not supported"):
        ct.gradient(results, gradients.Reaction("right", "y"), MODULUS)


def test_mass_without_a_density() -> None:
    model = beam(law=ct.Elastic(E=1000.0, nu=0.3))
    model.force("right", y=-0.1)
    with pytest.raises(ct.InputError, match="density"):
        ct.gradient(ct.solve(model, threads=1), gradients.Mass(), MODULUS)
