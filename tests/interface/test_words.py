"""Names are checked when they are given; errors are typed and give the nearest valid word."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pathlib

import numpy as np
import pytest

import corota as ct
from corota.model import local_strain

ROOT = pathlib.Path(__file__).parents[2]
STEEL = ct.Elastic(E=210e3, nu=0.3)


@pytest.fixture
def model() -> ct.Model:
    made = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    made.section(element="Q4D", material=STEEL)
    return made


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"element": "Q5"}, "no element 'Q5'.*did you mean 'Q"),
        ({"element": "Q4J"}, "did you mean 'Q4"),
        ({"element": 4}, "no element 4"),
        ({"local_strain": "log"}, "did you mean 'logarithmic'"),
        ({"local_strain": "green"}, "did you mean 'green_lagrange'"),
        ({"plane": "stres"}, "did you mean 'stress'"),
        ({"material": "steel"}, "needs a material"),
        ({"thickness": "thick"}, "thickness must be a number"),
        ({"thickness": np.nan}, "thickness must be a finite number"),
        ({"orientation": "x"}, "orientation must be a number"),
    ],
)
def test_sections(options: dict[str, object], words: str) -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    with pytest.raises(ct.InputError, match=words):
        model.section(**{"element": "Q4I", "material": STEEL, **options})  # type: ignore[arg-type]


def test_elements_are_named_in_any_case() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    model.section(element="q4i", material=STEEL)
    assert model.sections[0].element == "Q4I"


@pytest.mark.parametrize("dof", ["theta", "z", "UX", 3, 6, None, True])
def test_dofs_have_one_vocabulary(model: ct.Model, dof: object) -> None:
    calls = [
        lambda: model.equation((0, dof, 1.0), (1, dof, -1.0)),
        lambda: model.couple([0, 1], 2, dofs=(dof,)),
        lambda: model.spring([0], 1.0, dof if isinstance(dof, str) else [dof]),
        lambda: ct.Fixed([0], dof),
        lambda: ct.NodalForce([0], dof, 1.0),
        lambda: ct.ArcLength(displacement=("left", dof, 1.0)),
        lambda: ct.DisplacementControl("left", dof, 1.0),
    ]
    for call in calls:
        with pytest.raises(ct.InputError, match="there are 'x', 'y' and 'rotation'"):
            call()  # type: ignore[no-untyped-call]


def test_the_words_of_dofs_are_understood(model: ct.Model) -> None:
    model.equation((0, "x", 1.0), (1, "x", -1.0))
    model.couple([0, 1], 2, dofs="x rotation")
    assert ct.Fixed([0], "rotation").dof == 2
    assert ct.NodalForce([0], "y", 1.0).dof == 1
    with pytest.raises(ct.InputError, match="did you mean 'rotation'"):
        ct.Fixed([0], "theta")  # type: ignore[arg-type]


def test_other_words_are_answered_with_the_nearest(model: ct.Model) -> None:
    calls = {
        "hht": lambda: ct.Dynamic(scheme="htt"),
        "lumped": lambda: ct.Dynamic(mass="lumpd"),  # type: ignore[arg-type]
        "consistent": lambda: ct.Frequency(mass="consistant"),  # type: ignore[arg-type]
        "gripper": lambda: ct.examples.load("griper"),
    }
    for meant, call in calls.items():
        with pytest.raises(ct.InputError, match=f"did you mean '{meant}'"):
            call()
    with pytest.raises(ct.InputError, match="no degree of freedom"):
        model.equation((0, "z", 1.0))
    with pytest.raises(ct.InputError, match="a term is"):
        model.equation((0, 1.0))  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="node is given by its index"):
        model.rigid("left", 1.5)  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="did you mean 'top'"):
        model.rigid("left", "tip")
    with pytest.raises(ct.InputError, match="one node is expected; 'top' has"):
        model.rigid("left", "top")


@pytest.mark.parametrize("given", ["steel", None, [1.0]])
def test_constants_of_materials_are_numbers(given: object) -> None:
    with pytest.raises(ct.InputError, match="must be a number"):
        ct.Elastic(E=given)  # type: ignore[arg-type]


def test_unknown_objects_among_loads_and_supports_are_refused(model: ct.Model) -> None:
    for item in (("right", "y", 1.0), "right", ct.Static()):
        with pytest.raises(ct.InputError, match="is not a load"):
            ct.Static(loads=[item])  # type: ignore[list-item]
        with pytest.raises(ct.InputError, match="is not a support"):
            ct.Static(supports=[item])  # type: ignore[list-item]
    with pytest.raises(ct.InputError, match="is not a support"):
        ct.Static(supports=[ct.NodalForce([0], "x", 1.0)])  # type: ignore[list-item]
    with pytest.raises(ct.InputError, match="loads is a list"):
        ct.Static(loads=ct.NodalForce([0], "x", 1.0))  # type: ignore[arg-type]
    late = ct.Static()
    late.loads.append(("right", 1.0))  # type: ignore[arg-type]
    model.fix("left")
    with pytest.raises(ct.InputError, match="is not a load"):
        ct.solve(model, late, threads=1)


def test_two_supports_on_one_dof_are_refused(model: ct.Model) -> None:
    model.fix("left")
    model.fix([0], x=0.5, y=None)
    with pytest.raises(ct.ModelError, match=r"node 1 is given two values, 0 and 0.5, in x \(dof 1"):
        ct.solve(model, ct.Static(), threads=1)


def test_the_same_support_twice_and_one_of_a_later_step_are_not(model: ct.Model) -> None:
    model.fix("left")
    model.fix("bottom", x=None)
    step = ct.Static()
    step.fix("left", y=0.1)
    results = ct.solve(model, [ct.Static(), step], threads=1)
    assert results.history("U2", at=[5])[-1] == pytest.approx(0.1)


def test_messages_never_print_whole_arrays(model: ct.Model) -> None:
    many = np.arange(10)
    model.fix(many)
    model.fix(many, x=1.0)
    with pytest.raises(ct.ModelError) as caught:
        ct.solve(model, ct.Static(), threads=1)
    assert len(str(caught.value)) < 200
    model.supports.clear()
    model.fix("left")
    results = ct.solve(model, ct.Static(), threads=1)
    assert results.history("U2", at=many).name == "U2 at 10 nodes"


def test_a_result_that_is_not_there_is_answered_with_those_that_are(model: ct.Model) -> None:
    model.fix("left")
    results = ct.solve(model, ct.Static(), threads=1)
    with pytest.raises(ct.InputError, match="did you mean U") as caught:
        results.history("U3")
    assert "strain energy" in str(caught.value)
    with pytest.raises(ct.InputError, match="There are: U1"):
        results.history("V2")


def test_velocities_are_a_history_from_the_first_dynamic_step_on(model: ct.Model) -> None:
    moving = ct.Model(model.mesh)
    moving.section(element="Q4I", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    moving.fix("left")
    moving.force("right", y=0.01)
    results = ct.solve(moving, [ct.Static(), ct.Dynamic(period=0.1, increments=2)], threads=1)
    speed = results.history("V2", at="right")
    assert speed[0] == 0.0  # a static frame is at rest, in memory as in files
    assert speed[-1] != 0.0
    assert np.isfinite(speed.max())


def test_every_name_that_the_page_of_results_lists_is_a_history() -> None:
    from corota.results.table import COMPONENTS, HARMONIC, INVARIANTS, NODAL

    moving = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    moving.section(
        element="Q4D", material=ct.Mises(E=1.0, nu=0.3, rho=1.0, yield_stress=1.0, expansion=1e-5)
    )
    moving.fix("left")
    moving.contact("right", ct.RigidCurve.line((11.0, -5.0), (11.0, 5.0)))
    step = ct.Dynamic(period=0.1, increments=1)
    step.force("right", y=1e-3)
    step.temperature(1.0)
    results = ct.solve(moving, step, threads=1)
    tensors = [name for name, (tensor, _) in COMPONENTS.items() if tensor in ("S", "E")]
    nodal = [name for name in NODAL if name not in HARMONIC]
    for name in [*nodal, *tensors, *INVARIANTS, "PEEQ", "ENER"]:
        assert np.isfinite(results.history(name)[-1]), name
    moving.contacts.clear()
    shaken = ct.SteadyState(lowest=0.1, highest=0.2, points=2, damping=0.01)
    shaken.force("right", y=1e-3)
    results = ct.solve(moving, [ct.Frequency(modes=1), shaken], threads=1)
    amplitudes = [name for name, (tensor, _) in COMPONENTS.items() if tensor == "SA"]
    for name in [*HARMONIC, *amplitudes, "MISESA"]:
        assert np.isfinite(results.history(name)[-1]), name


def test_one_text_says_which_local_strain_to_take() -> None:
    for page in ("tutorial.md", "plasticity.md"):
        text = " ".join((ROOT / "docs" / page).read_text(encoding="utf-8").replace(">", "").split())
        assert local_strain.ADVICE in text, page
    flowing = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    law = ct.Mises(E=1.0, nu=0.3, yield_stress=1.0)
    flowing.section(element="Q4I", material=law, local_strain="linear")
    flowing.fix("left")
    flowing.force("right", y=1e-6)
    flowing.steps = [ct.Static()]
    assert any(local_strain.ADVICE in d.message for d in flowing.check())


@pytest.mark.parametrize(
    ("call", "new"),
    [
        (lambda: ct.mesh.annulus(1.0, 2.0, 1, 8, centre=(3.0, 0.0)), "center"),
        (lambda: ct.RigidCurve.circle(centre=(0.0, 0.0), radius=1.0), "center"),
        (lambda: ct.ContactPair("a", "b", stabilise=True), "stabilize"),
        (lambda: ct.LocalAxes("a", centre=(0.0, 0.0)), "center"),
        (
            lambda: ct.mesh.to_quadratic(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1), centre=True),
            "center",
        ),
    ],
)
def test_former_keywords_work_and_name_the_new_one(call, new) -> None:
    with pytest.warns(DeprecationWarning, match=f"is now called {new}"):
        call()
