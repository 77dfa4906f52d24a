"""Steps, amplitudes, loads and sections of decks as Abaqus/CAE writes them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "io"))
from decks import DECK, SECTION, faults, read

import corota as ct


def static(text: str) -> str:
    return DECK.replace("*STATIC\n", text)


def test_parameters_of_static_steps(tmp_path: Path) -> None:
    # STABILIZE is a word of Abaqus.
    plain = ct.solve(read(tmp_path, "** DIALECT: abaqus\n" + DECK)).frames[-1].U
    text = DECK.replace("*STEP, NLGEOM", "*STEP, NLGEOM, EXTRAPOLATION=NO, UNSYMM=YES").replace(
        "*STATIC", "*STATIC, STABILIZE=0.0002, ALLSDTOL=0.05, CONTINUE=NO"
    )
    model = read(tmp_path, text)
    assert any("no artificial damping" in note for note in model.notes)
    again = ct.solve(model).frames[-1].U
    assert again == pytest.approx(plain, rel=1e-12)


def test_a_jump_under_stabilize_ends_in_the_equilibrium_beyond_it(tmp_path: Path) -> None:
    """A shallow truss that snaps through: 2 N (h - v) / L = P, N = E A (1 - L / L0)."""
    text = """*NODE
1, 0., 0.
2, 1., .1
3, 2., 0.
*ELEMENT, TYPE=T2D2, ELSET=T
1, 1, 2
2, 2, 3
*SOLID SECTION, ELSET=T, MATERIAL=M
1.
*MATERIAL, NAME=M
*ELASTIC
1.E4
*BOUNDARY
1, 1, 2
3, 1, 2
*STEP, NLGEOM, INC=1000
*STATIC{more}
.02, 1., 1e-8, .05
*CLOAD
2, 2, -10.
*END STEP
"""
    frame = ct.solve(read(tmp_path, text.format(more=", STABILIZE"))).frames[-1]
    height = 0.1 + frame.U[1, 1]
    assert height < -0.1
    length = math.hypot(1.0, height)
    force = 2e4 * (length / math.hypot(1.0, 0.1) - 1.0) * -height / length
    assert force == pytest.approx(10.0, rel=1e-8)
    with pytest.raises(ct.CorotaError, match="limit point"):
        ct.solve(read(tmp_path, text.format(more="")))


def test_perturbation_of_the_first_step_is_linear(tmp_path: Path) -> None:
    text = DECK.replace("*STEP, NLGEOM", "*STEP, PERTURBATION")
    assert not read(tmp_path, text).steps[0].nlgeom
    case = text[text.index("*STEP") :]
    # A second one is a load case of its own; after a step that loads, its base would be that state.
    assert [s.nlgeom for s in read(tmp_path, text + case).steps] == [False, False]
    assert any("perturbation of a loaded state" in d.message for d in faults(tmp_path, DECK + case))


@pytest.mark.parametrize(
    ("card", "expected"),
    [
        ("DEFINITION=SMOOTH STEP\n0., 0., 2., 4.", {1.0: 2.0, 0.5: 4.0 * 0.103515625, 3.0: 4.0}),
        ("DEFINITION=EQUALLY SPACED, FIXED INTERVAL=.5\n0., 2., 1.", {0.25: 1.0, 1.0: 1.0}),
        (
            "DEFINITION=PERIODIC\n2, 6.283185307179586, 0.25, 1.\n0., 2., 0.5, 0.",
            {0.1: 1.0, 0.5: 1.0 + 2.0 - 0.5, 0.75: 1.5},
        ),
        ("DEFINITION=DECAY\n1., 2., 0., 0.5", {0.5: 1.0 + 2.0 / math.e, 1.0: 1 + 2 / math.e**2}),
        ("INPUT=table.txt", {0.5: 1.5}),
    ],
)
def test_amplitudes(tmp_path: Path, card: str, expected: dict[float, float]) -> None:
    (tmp_path / "table.txt").write_text("0., 1.\n1., 2.\n")
    text = DECK.replace("*STEP", f"*AMPLITUDE, NAME=a, {card}\n*STEP", 1).replace(
        "*CLOAD", "*CLOAD, AMPLITUDE=a"
    )
    table = read(tmp_path, text).amplitudes["a"]
    for time, value in expected.items():
        assert table(time) == pytest.approx(value, abs=3e-5), time


def test_faults_of_amplitudes(tmp_path: Path) -> None:
    for card, message in (
        ("DEFINITION=PERIODIC\n2, 1., 0., 0.\n1., 2.", "pairs"),
        ("DEFINITION=DECAY\n1., 2., 0., 0.", "decay time"),
        ("DEFINITION=EQUALLY SPACED\n1., 2.", "FIXED INTERVAL"),
        ("DEFINITION=SMOOOTH\n1., 2.", "is not known"),
    ):
        text = DECK.replace("*STEP", f"*AMPLITUDE, NAME=a, {card}\n*STEP", 1)
        found = faults(tmp_path, text)
        assert any(message in str(d) for d in found), (card, list(map(str, found)))


def test_shear_along_the_edges_of_a_surface(tmp_path: Path) -> None:
    text = DECK.replace("*STEP, NLGEOM", "*SURFACE, NAME=top\neall, S3\n*STEP").replace(
        "*CLOAD\n3, 2, -5.", "*DSLOAD\ntop, TRSHR, 3., 1., 0.5"
    )
    model = read(tmp_path, text)
    assert [(x.kind, x.value) for x in model.steps[0].loads] == [("shear", (-3.0,))]
    frame = ct.solve(model).frames[-1]
    # 3 of traction over the area 2 x 2.
    assert frame.RF.sum(axis=0)[:2] == pytest.approx([-12.0, 0.0], abs=1e-9)
    for follower, kind in (("", "following traction"), (", FOLLOWER=NO", "traction")):
        vector = text.replace("*DSLOAD\ntop, TRSHR", f"*DSLOAD{follower}\ntop, TRVEC")
        assert read(tmp_path, vector).steps[0].loads[0].kind == kind


@pytest.mark.filterwarnings("ignore:local strain")
def test_a_traction_that_follows_stays_with_the_edge(tmp_path: Path) -> None:
    """A block turned by 90 degrees: the reaction turns with it, or not."""
    text = DECK.replace("*STEP, NLGEOM", "*SURFACE, NAME=top\neall, S3\n*STEP, NLGEOM")
    model = read(tmp_path, text)
    x = model.mesh.points
    turn = "".join(
        f"{n}, 1, 1, {-p[1] - p[0]!r}\n{n}, 2, 2, {p[0] - p[1]!r}\n"
        for n, p in zip(model.mesh.node_labels.tolist(), x.tolist(), strict=True)
    )
    for card, expected in (
        ("TRVEC, 3., 1., 0.", [0.0, -12.0]),
        ("TRVEC, 3., 1., 0.\n** dead", [-12.0, 0.0]),
        ("TRSHR, 3., 1., 0.", [0.0, -12.0]),
    ):
        follower = ", FOLLOWER=NO" if "dead" in card else ""
        moved = text.replace(
            "*CLOAD\n3, 2, -5.", f"*BOUNDARY\n{turn}*DSLOAD{follower}\ntop, {card}"
        )
        frame = ct.solve(read(tmp_path, moved)).frames[-1]
        assert frame.RF.sum(axis=0)[:2] == pytest.approx(expected, abs=1e-7), card


def test_forces_that_would_follow(tmp_path: Path) -> None:
    text = DECK.replace("*CLOAD", "*CLOAD, FOLLOWER")
    assert any("has no rotation" in d.message for d in faults(tmp_path, text))
    assert read(tmp_path, text.replace(", NLGEOM", "")).steps[0].loads[0].value == -5.0
    load = read(tmp_path, text, element_map={"CPS4": "Q4D"}).steps[0].loads[0]
    assert load.follower


def test_application_and_parameters_of_dynamics(tmp_path: Path) -> None:
    rho = DECK.replace("*ELASTIC", "*DENSITY\n1.\n*ELASTIC")
    step = read(tmp_path, rho.replace("*STATIC", "*DYNAMIC, APPLICATION=QUASI-STATIC")).steps[0]
    assert (step.scheme, step.rho_inf, step.ramp) == ("generalized_alpha", 0.0, True)
    step = read(tmp_path, rho.replace("*STATIC", "*DYNAMIC, BETA=.25, GAMMA=.5, ALPHA=0.")).steps[0]
    assert (step.scheme, step.alpha) == ("hht", 0.0)
    model = read(tmp_path, rho.replace("*STATIC", "*DYNAMIC, BETA=.25, GAMMA=.5"))
    assert model.steps[0].alpha == 0.0
    assert any("ALPHA=0, which belongs to the GAMMA given" in note for note in model.notes)
    step = read(tmp_path, rho.replace("*STATIC", "*DYNAMIC, GAMMA=.6")).steps[0]
    assert step.alpha == pytest.approx(-0.1)
    found = faults(tmp_path, rho.replace("*STATIC", "*DYNAMIC, BETA=.3, GAMMA=.5"))
    assert any("BETA=0.3 does not belong to ALPHA=0" in d.message for d in found)
    found = faults(tmp_path, rho.replace("*STATIC", "*DYNAMIC, GAMMA=.4"))
    assert any("does not belong to ALPHA" in d.message for d in found)
    found = faults(tmp_path, rho.replace("*STATIC", "*DYNAMIC, GAMMA=.7, ALPHA=0."))
    assert any("does not belong to ALPHA" in d.message for d in found)


def test_words_of_parameters_may_be_abbreviated(tmp_path: Path) -> None:
    table = "*AMPLITUDE, NAME=A, TIME=TOT, VALUE=REL\n0., 0., 1., 1.\n*STEP"
    text = DECK.replace("*STEP", table, 1).replace("*CLOAD", "*CLOAD, AMP=A")
    assert read(tmp_path, text).amplitudes["A"].total_time
    for wrong in ("TIME=TO", "TIME=TIME"):
        found = faults(tmp_path, text.replace("TIME=TOT", wrong))
        assert any("is not known; expected" in d.message for d in found), wrong


def test_constants_at_the_temperature_of_the_model(tmp_path: Path) -> None:
    text = DECK.replace("210000., .3", "200000., .3, 0.\n100000., .2, 100.")
    assert read(tmp_path, text).sections[0].material.E == 200000.0
    warm = text.replace("*STEP", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nnall, 50.\n*STEP", 1)
    material = read(tmp_path, warm).sections[0].material
    assert (material.E, material.nu) == pytest.approx((150000.0, 0.25))
    part = warm.replace("nall, 50.", "3, 50.")
    heated = warm.replace("*CLOAD", "*TEMPERATURE\nnall, 60.\n*CLOAD")
    for varying in (part, heated):
        assert isinstance(read(tmp_path, varying).sections[0].material, ct.MaterialTable)


def test_axes_about_a_point_matter_to_orthotropic_materials_only(tmp_path: Path) -> None:
    text = DECK.replace(
        "*SOLID SECTION",
        "*ORIENTATION, NAME=o, SYSTEM=CYLINDRICAL\n"
        "0., 0., 0., 0., 0., 1.\n*SOLID SECTION, ORIENTATION=o",
    )
    assert any("isotropic material do not matter" in n for n in read(tmp_path, text).notes)
    lamina = text.replace("*ELASTIC\n210000., .3", "*ELASTIC, TYPE=LAMINA\n2e5, 1e5, .2, 5e4")
    assert any("turn about a point" in d.message for d in faults(tmp_path, lamina))


BEAM = """*PART, NAME=P
*NODE
1, 0., 0.
2, 10., 0.
*ELEMENT, TYPE=B21, ELSET=e
1, 1, 2
*BEAM SECTION, ELSET=e, MATERIAL=steel, TEMPERATURE=GRADIENTS, SECTION=CIRC
0.5
0., 0., -1.
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=I, PART=P
*END INSTANCE
*END ASSEMBLY
""" + SECTION.split("*SOLID")[0]


@pytest.mark.parametrize(
    ("kind", "sizes", "area", "inertia"),
    [
        ("CIRC", "0.5", math.pi / 4, math.pi / 64),
        ("BOX", "2., 3., .1, .1, .1, .1", 6 - 1.8 * 2.8, (2 * 27 - 1.8 * 2.8**3) / 12),
        ("I", "1.5, 3., 2., 2., .1, .1, .2", 0.4 + 0.56, (2 * 27 - 1.8 * 2.8**3) / 12),
    ],
)
def test_sections_of_beams(
    tmp_path: Path, kind: str, sizes: str, area: float, inertia: float
) -> None:
    text = BEAM.replace("CIRC\n0.5", f"{kind}\n{sizes}")
    assert read(tmp_path, text).sections[0].profile[:2] == pytest.approx((area, inertia))
    if kind == "I":
        found = faults(tmp_path, text.replace("1.5, 3.", "1., 3."))
        assert any("must be at the center, 1.5" in d.message for d in found)


def test_a_circle_of_unknown_origin_is_refused(tmp_path: Path) -> None:
    flat = "*NODE\n1, 0., 0.\n2, 10., 0.\n*ELEMENT, TYPE=B31, ELSET=e\n1, 1, 2\n"
    flat += (
        "*BEAM SECTION, ELSET=e, MATERIAL=steel, SECTION=CIRC\n0.5\n" + BEAM.split("ASSEMBLY\n")[-1]
    )
    assert any("radius in Abaqus" in d.message for d in faults(tmp_path, flat))
    assert np.isfinite(read(tmp_path, flat.replace("0.5\n", "0.5, 0.5\n")).sections[0].profile[0])
