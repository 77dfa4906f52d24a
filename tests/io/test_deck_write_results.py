"""A model and the deck written from it have the same results, for all that decks can say."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.model.contact import PressureLaw, RigidCurve
from corota.model.loads import Fixed, NodalForce

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

#: Sums in another order change the last digits.
ROUNDOFF = 1e-9


def strip(material: ct.Material | None = None, kind: str = "quad4", **options: object) -> ct.Model:
    """A cantilever of eight elements, plane strain."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2, kind))
    element = {"quad4": "Q4I", "quad8": "Q8R"}[kind]
    law = material or ct.Elastic(1000.0, 0.3, rho=0.01)
    model.section(element=element, material=law, plane="strain", thickness=0.5, **options)  # type: ignore[arg-type]
    model.fix("left")
    return model


def pulled(material: ct.Material) -> ct.Model:
    """Tension, compression, tension: through isotropic and kinematic hardening."""
    model = strip(material, local_strain="logarithmic")
    model.amplitudes["cycle"] = ct.Amplitude([0.0, 1.0, 3.0, 5.0], [0.0, 1.0, -1.0, 1.5])
    model.fix("right", x=0.05, y=None, amplitude="cycle")
    model.steps = [ct.Static(period=5.0, increments=10)]
    return model


def equation() -> ct.Model:
    model = strip()
    right = model.mesh.node_sets["right"]
    for node in right[1:]:
        model.equation((int(node), "x", 1.0), (int(right[0]), "x", -1.0))
    model.force("right", x=3.0, y=-1.0)
    return model


def coupled(kind: str, dofs: str = "x y rotation", weights: list[float] | None = None) -> ct.Model:
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 2)
    mesh.points = np.concatenate([mesh.points, [[5.0, 0.5]]])
    mesh.node_labels = np.arange(1, len(mesh.points) + 1)
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(1000.0, 0.3))
    model.fix("left")
    reference = mesh.n_nodes - 1
    model.couple("right", reference, kind=kind, dofs=dofs, weights=weights)  # type: ignore[arg-type]
    free = {"x y rotation": {}, "x rotation": {"y": 0.0}, "x y": {"rotation": 0.0}}[dofs]
    model.fix([reference], **{"x": None, "y": None, **free})
    moment = 2.0 if "rotation" in dofs else 0.0
    model.force([reference], x=1.0, y=0.0 if "y" in free else -1.0, moment=moment)
    return model


def straight() -> ct.Model:
    model = strip()
    nodes = model.mesh.node_sets["right"]
    model.straight("right", int(nodes[0]), int(nodes[-1]))
    model.force([int(nodes[1])], x=5.0)
    model.force("top", y=-1.0)
    return model


def axes(center: tuple[float, float] | None) -> ct.Model:
    model = strip()
    model.local_axes("right", angle=0.0 if center else 0.6, center=center)
    model.fix("right", x=0.0, y=-0.05)
    return model


def paths() -> ct.Model:
    model = strip()
    corner = int(model.mesh.node_sets["right"][0])
    model.force("right", y=-20.0)
    end = (corner, "y", -0.2)
    model.steps = [ct.Static(path=ct.ArcLength(displacement=end, factor=3.0), increments=8)]
    return model


def stepwise() -> ct.Model:
    """Supports and loads of the model beside steps that forget those before."""
    model = strip(local_strain="logarithmic")
    model.force("right", y=-2.0)
    model.steps = [ct.Static(increments=2) for _ in range(4)]
    model.steps[1].fix("top", y=-0.01, x=None)
    model.steps[2].new_supports = True
    model.steps[2].fix("right", x=0.02, y=None)
    model.steps[3] = ct.Static(new_loads=("force",), new_supports=True)
    model.steps[3].supports = [Fixed("left", 0, keep=True), Fixed("left", 1, keep=True)]
    return model


def loaded() -> ct.Model:
    """Every load on a body, with a resultant on curved edges and a shear round the body."""
    model = ct.Model(ct.mesh.annulus(1.0, 2.0, 2, 12, cell="quad8"))
    steel = ct.Elastic(1000.0, 0.3, rho=0.1, expansion=1e-4)
    model.section(element="Q8R", material=steel, thickness=0.5)
    model.fix("inner")
    model.shear("outer", 0.5)
    model.force("outer", x=3.0, y=-1.0)
    model.pressure("outer", 2.0)
    model.traction("outer", x=0.4, y=0.1, follow=True)
    model.gravity(y=-9.81)
    model.centrifugal(2.0, about=(0.1, 0.0))
    model.temperature(30.0)
    model.temperature(5.0, "outer")
    nodes = model.mesh.node_sets["outer"][:3]
    model.loads.append(NodalForce(nodes, 0, np.array([0.1, 0.2, 0.3])))
    return model


def dynamic(*steps: ct.Dynamic | ct.Frequency, **damping: object) -> ct.Model:
    model = strip(ct.Elastic(1000.0, 0.3, rho=0.01, **damping))  # type: ignore[arg-type]
    model.force("right", y=-1.0)
    model.steps = list(steps)
    return model


def flung() -> ct.Model:
    """A free bar with a spin, point masses and a dashpot along its axis."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    model.section(element="Q4D", material=ct.Elastic(1000.0, 0.3, rho=0.01))
    model.velocity(x=1.0, spin=0.8, about=(0.5, 0.2))
    model.velocity("right", y=0.3)
    right = model.mesh.node_sets["right"]
    model.point_mass("right", 0.02)
    model.dashpot(0, int(right[0]), c=0.3)
    model.steps = [ct.Dynamic(period=0.2, increments=10, scheme="energy_momentum")]
    return model


def pressed() -> ct.Model:
    """A block between a floor and a rigid disc that a node carries, with friction."""
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 2)
    mesh.points = np.concatenate([mesh.points, [[2.0, 2.0]]])
    mesh.node_labels = np.arange(1, len(mesh.points) + 1)
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(1000.0, 0.3))
    disc = mesh.n_nodes - 1
    model.contact(mesh.edge_sets["bottom"], RigidCurve.line((-1.0, 0.0), (5.0, 0.0)), friction=0.2)
    model.contact(
        "top",
        RigidCurve.circle((2.0, 2.0), 1.0, reference=disc),
        law=PressureLaw("linear", [1e4]),  # type: ignore[arg-type]
        method="node_to_segment",
        start="adjust",
    )
    model.contacts[0].start = "adjust"
    model.contacts[0].adjust_nodes = mesh.node_sets["bottom"]
    model.fix([disc], x=0.0, y=-0.05, rotation=True)
    model.fix("left", y=None)
    model.steps = [ct.Static(increments=2)]
    return model


def vibrating(direct: bool) -> ct.Model:
    model = strip()
    model.section(element="Q4I", material=ct.Elastic(1000.0, 0.3, rho=0.01), plane="strain")
    del model.sections[0]
    sweep = ct.SteadyState(lowest=1.0, highest=60.0, points=4, direct=direct, rayleigh=(0.1, 1e-4))
    sweep.force("right", y=1.0)
    sweep.imaginary_loads = [NodalForce("top", 1, 0.2)]
    ring = ct.ModalDynamic(
        period=0.1, increments=10, damping=[(1, 2, 0.02), (3, 4, 0.1)], rayleigh=(0.2, 0.0)
    )
    ring.force("right", y=1.0)
    model.steps = [ct.Frequency(modes=4), sweep, ring]
    return model


def buckling() -> ct.Model:
    model = strip()
    model.force("right", x=-1.0)
    model.steps = [ct.Static(), ct.Buckle(modes=2), ct.Buckle(modes=1, preload=False)]
    return model


CURVE = [(1.0, 0.0), (1.5, 0.02), (1.8, 0.1)]
MODELS: dict[str, Callable[[], ct.Model]] = {
    "yield curve": lambda: pulled(ct.Mises(210.0, 0.3, yield_curve=CURVE)),
    "perfect plasticity": lambda: pulled(ct.Mises(210.0, 0.3, yield_stress=1.0)),
    "linear hardening": lambda: pulled(ct.Mises(210.0, 0.3, yield_stress=1.0, isotropic=20.0)),
    "Voce": lambda: pulled(ct.Mises(210.0, 0.3, yield_stress=1.0, isotropic=ct.Voce(1.0, 20.0))),
    "kinematic": lambda: pulled(ct.Mises(210.0, 0.3, yield_stress=1.0, kinematic=15.0)),
    "Chaboche, curve": lambda: pulled(
        ct.Mises(210.0, 0.3, yield_curve=CURVE, chaboche=[(90.0, 60.0), (9.0, 2.0), (3.0, 0.0)])
    ),
    "Chaboche, many": lambda: pulled(
        ct.Mises(210.0, 0.3, yield_stress=1.0, chaboche=[(9.0 + i, 2.0 * i) for i in range(6)])
    ),
    "Chaboche, Voce": lambda: pulled(
        ct.Mises(210.0, 0.3, yield_stress=1.0, isotropic=ct.Voce(1.0, 20.0), chaboche=[(9.0, 2.0)])
    ),
    "Ramberg-Osgood": lambda: pulled(ct.RambergOsgood(210.0, 0.3, 1.0, 8.0, 0.4)),
    "equations": equation,
    "rigid": lambda: coupled("kinematic"),
    "kinematic, some dofs": lambda: coupled("kinematic", "x rotation"),
    "distributing": lambda: coupled("distributing"),
    "distributing, weights": lambda: coupled("distributing", weights=[1.0, 3.0, 2.0]),
    "distributing, some dofs": lambda: coupled("distributing", "x y"),
    "straight line": straight,
    "turned axes": lambda: axes(None),
    "polar axes": lambda: axes((0.0, 3.0)),
    "arc length": paths,
    "steps": stepwise,
    "loads": loaded,
    "HHT": lambda: dynamic(ct.Dynamic(period=0.1, increments=10, rayleigh=(0.1, 1e-4), ramp=True)),
    "Newmark": lambda: dynamic(ct.Dynamic(period=0.1, increments=10, scheme="newmark")),
    "automatic increments": lambda: dynamic(ct.Dynamic(period=0.1, first_increment=0.01)),
    "quasi-static": lambda: dynamic(
        ct.Dynamic(period=0.1, increments=10, scheme="generalized_alpha", rho_inf=0.0)
    ),
    "explicit": lambda: dynamic(ct.Dynamic(period=0.02, scheme="central_difference")),
    "damped materials": lambda: dynamic(
        ct.Dynamic(period=0.1, increments=10), rayleigh=(0.5, 1e-4)
    ),
    "frequencies": lambda: dynamic(ct.Frequency(modes=3, nlgeom=False)),
    "complex frequencies": lambda: dynamic(
        ct.Frequency(modes=3, complex_modes=True, rayleigh=(0.1, 1e-4))
    ),
    "flight": flung,
    "contact": pressed,
    "harmonic, modal": lambda: vibrating(False),
    "harmonic, direct": lambda: vibrating(True),
    "buckling": buckling,
}


def numbers(results: ct.Results) -> np.ndarray:
    """Displacements, reactions and stresses of all frames, and eigenvalues."""
    found = [np.asarray(modes.factors) for modes in results.modes]
    for frame in results.frames:
        found += [frame.U.ravel(), frame.UR.ravel(), frame.RF.ravel()]
        found += [field.values["S"].ravel() for field in frame.fields if "S" in field.values]
    return np.concatenate(found)


# Compressed beyond yield, the cantilever of `pulled` bends at its tangent modulus; without
# hardening it necks in tension.
@pytest.mark.filterwarnings("ignore:increment .* a bifurcation or limit point:UserWarning")
@pytest.mark.parametrize("name", MODELS)
def test_results_survive_a_round_trip(tmp_path: Path, name: str) -> None:
    model = MODELS[name]()
    steps = model.steps or [ct.Static()]
    again = ct.read(ct.write(model, tmp_path / "again.inp", steps))
    wanted = numbers(ct.solve(model, steps, threads=1))
    found = numbers(ct.solve(again, threads=1))
    assert len(wanted) == len(found)
    assert len(wanted)
    np.testing.assert_allclose(found, wanted, rtol=1e-6, atol=ROUNDOFF * np.abs(wanted).max())


def test_every_procedure_of_decks_is_written() -> None:
    from corota.io.deck.write.steps import PROCEDURES

    steps = (ct.Static, ct.Visco, *ct.model.steps.Step.__subclasses__())
    assert {step for step in steps if step.__module__ == "corota.model.steps"} == set(PROCEDURES)
