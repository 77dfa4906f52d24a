"""Cards as CAE and users of CalculiX write them: base motion, buckling supports, equations."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.check import examine

OSCILLATOR = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
*ELEMENT, TYPE=SPRING2, ELSET=SP
1, 1, 2
*ELEMENT, TYPE=MASS, ELSET=MS
2, 2
*SPRING, ELSET=SP
1, 1
100.
*MASS, ELSET=MS
4.
*AMPLITUDE, NAME=A
0., 2., 1000., 2.
*BOUNDARY
1, 1, 2
2, 2
*STEP
*FREQUENCY
1
*END STEP
*STEP
{procedure}
{motion}
*END STEP
"""


def read(path: Path, text: str) -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.read(deck)


@pytest.mark.parametrize("direct", ["", ", DIRECT"])
@pytest.mark.parametrize("type_", ["ACCELERATION", "DISPLACEMENT", ""])
def test_harmonic_base_motion(tmp_path: Path, type_: str, direct: str) -> None:
    """Moved support: u = b w0^2 / (w0^2 - w^2) with the base's b, or b = -a / w^2."""
    motion = "*BASE MOTION, DOF=1, AMPLITUDE=A" + (f", TYPE={type_}" if type_ else "")
    procedure = f"*STEADY STATE DYNAMICS{direct}\n.9, 2., 7"
    model = read(tmp_path, OSCILLATOR.format(procedure=procedure, motion=motion))
    frames = [f for f in ct.solve(model, threads=1).frames if f.step == 2]
    assert len(frames) > 3
    for frame in frames:
        w = 2.0 * math.pi * frame.scalars["frequency"]
        if abs(w - 5.0) < 0.1:
            continue
        base = 2.0 if type_ == "DISPLACEMENT" else -2.0 / w**2
        assert frame.U[0, 0] == pytest.approx(base, rel=1e-9)
        assert frame.U[1, 0] == pytest.approx(base * 25.0 / (25.0 - w**2), rel=1e-6)


def test_transient_base_motion(tmp_path: Path) -> None:
    """A base that starts with the acceleration a: it is left behind by a (1 - cos w0 t) / w0^2."""
    procedure = "*MODAL DYNAMIC\n.01, 1."
    motion = "*BASE MOTION, DOF=1, AMPLITUDE=A, SCALE=0.5"
    model = read(tmp_path, OSCILLATOR.format(procedure=procedure, motion=motion))
    frame = ct.solve(model, threads=1).frames[-1]
    assert frame.U[0, 0] == pytest.approx(0.5, rel=1e-9)
    relative = -(1.0 - math.cos(5.0)) / 25.0
    assert frame.U[1, 0] - frame.U[0, 0] == pytest.approx(relative, rel=1e-3)


@pytest.mark.parametrize(
    ("motion", "said"),
    [
        ("*BASE MOTION, DOF=1", "AMPLITUDE= is missing"),
        ("*BASE MOTION, DOF=3, AMPLITUDE=A", "DOF must be 1 or 2"),
        ("*BASE MOTION, DOF=1, AMPLITUDE=B", "no amplitude named"),
        ("*BASE MOTION, DOF=1, AMPLITUDE=A, LOAD CASE=2", "in phase"),
        ("*BASE MOTION, DOF=1, AMPLITUDE=A, TYPE=VELOCITY", "displacement or the acceleration"),
    ],
)
def test_base_motion_that_is_refused(tmp_path: Path, motion: str, said: str) -> None:
    text = OSCILLATOR.format(procedure="*STEADY STATE DYNAMICS\n.9, 2., 7", motion=motion)
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, text)
    assert said in str(caught.value)


COLUMN = """*NODE, NSET=NALL
1, 0., 0.
2, 5., 0.
3, 10., 0.
*ELEMENT, TYPE=B21, ELSET=EA
1, 1, 2
2, 2, 3
*NSET, NSET=L
1
*NSET, NSET=R
3
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*BEAM SECTION, ELSET=EA, MATERIAL=M, SECTION=RECT
1., 1.
0, 0, -1
*STEP, NAME=S1, NLGEOM=NO, PERTURBATION
*BUCKLE
1, , 2, 30
*BOUNDARY, OP=NEW, LOAD CASE=1
L, 1, 2
R, 2, 2
{second}*CLOAD
R, 1, -1.
*END STEP
"""


def test_buckling_supports_that_cae_writes_twice(tmp_path: Path) -> None:
    second = "*BOUNDARY, OP=NEW, LOAD CASE=2\nL, 1, 2\nR, 2, 2\n"
    factors = [
        ct.solve(read(tmp_path, COLUMN.format(second=text)), threads=1).modes[-1].factors
        for text in ("", second)
    ]
    np.testing.assert_allclose(factors[1], factors[0], rtol=1e-12)


def test_other_supports_of_the_modes_are_refused(tmp_path: Path) -> None:
    second = "*BOUNDARY, OP=NEW, LOAD CASE=2\nL, 1, 2\nR, 2, 2\nR, 6, 6\n"
    with pytest.raises(ct.DeckError, match="the modes have other supports"):
        read(tmp_path, COLUMN.format(second=second))


PERIODIC = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=EA
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NODE
9, 5., 5.
*NSET, NSET=LEFT{unsorted}
4, 1
*NSET, NSET=RIGHT
3, 6
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=EA, MATERIAL=M
1.
*EQUATION
3
RIGHT, 1, 1., LEFT, 1, -1., 9, 1, -1.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*BOUNDARY
9, 1, 1, .01
*END STEP
"""


def test_equation_between_node_sets(tmp_path: Path) -> None:
    """Node by node in the order of the numbers; a single node is in every equation."""
    model = read(tmp_path, PERIODIC.format(unsorted=""))
    assert [[t[0] for t in c.terms] for c in model.constraints] == [[2, 0, 6], [5, 3, 6]]
    frame = ct.solve(model, threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[[2, 5], 0], 0.01, rtol=1e-12)


def test_unsorted_sets_keep_their_order(tmp_path: Path) -> None:
    model = read(tmp_path, PERIODIC.format(unsorted=", UNSORTED"))
    assert [[t[0] for t in c.terms] for c in model.constraints] == [[2, 3, 6], [5, 0, 6]]


def test_sets_of_unequal_size_are_refused(tmp_path: Path) -> None:
    text = PERIODIC.format(unsorted="").replace("\n3, 6\n", "\n3, 5, 6\n")
    with pytest.raises(ct.DeckError, match="as many nodes or one"):
        read(tmp_path, text)


def test_nohaf_leaves_the_increments_to_the_iterations(tmp_path: Path) -> None:
    """Without the residual at the half increment the increment grows to its bound."""
    text = PERIODIC.format(unsorted="").replace("*ELASTIC", "*DENSITY\n1e-3\n*ELASTIC")
    text = text.replace("*STEP\n", "*STEP, INC=10000\n")
    text = text.replace("*STATIC", "*DYNAMIC{0}\n1e-3, .2, 1e-9, .1")
    counts = []
    for more in ("", ", NOHAF"):
        model = read(tmp_path, text.replace("{0}", more))
        counts.append(len(ct.solve(model, threads=1).frames))
        again = tmp_path / "again.inp"
        ct.write(model, again)
        assert ("NOHAF" in again.read_text()) == bool(more)
    assert counts[1] < counts[0]


def test_reference_nodes_are_known_to_the_check(tmp_path: Path) -> None:
    text = PERIODIC.format(unsorted="").replace("9, 1, 1, .01", "").replace("*BOUNDARY\n\n", "")
    text = text.replace("*STATIC\n", "*STATIC\n*CLOAD\n9, 1, 1.\n")
    found, code = examine(read(tmp_path, text))
    assert code == 0
    assert not [d for d in found if "belongs to no cell" in d.message]


def test_a_part_in_another_plane_has_one_message(tmp_path: Path) -> None:
    """Elements without area, loads and supports out of the plane follow from the coordinates."""
    nodes = "".join(f"{1 + i + 4 * j}, {i}., 0., {j}.\n" for j in range(3) for i in range(4))
    cells = "".join(
        f"{1 + i + 3 * j}, {1 + i + 4 * j}, {2 + i + 4 * j}, {6 + i + 4 * j}, {5 + i + 4 * j}\n"
        for j in range(2)
        for i in range(3)
    )
    text = (
        f"*NODE\n{nodes}*ELEMENT, TYPE=CPS4, ELSET=E\n{cells}*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*BOUNDARY\n1, 1, 3\n*STEP\n*STATIC\n"
        "*CLOAD\n11, 3, 1.\n12, 3, 1.\n*END STEP\n"
    )
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, text)
    assert len(caught.value.diagnostics) == 1
    assert "exchange y and z" in str(caught.value)


def test_parameters_without_effect_are_noted(tmp_path: Path) -> None:
    text = PERIODIC.format(unsorted="")
    text = text.replace("MATERIAL=M\n1.", "MATERIAL=M, STACK DIRECTION=3, LAYUP=A\n1.")
    notes = read(tmp_path, text).notes
    assert sum("is ignored" in note for note in notes) == 2


ASSEMBLY = """*PART, NAME=P
*NODE
1, 0., 0.
2, 4., 0.
3, 4., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
1.,
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=P-1, PART=P
*END INSTANCE
*INSTANCE, NAME=P-2, PART=P
6., 0.
*END INSTANCE
*ELEMENT, TYPE={type}, ELSET=Springs/Dashpots-1
{nodes}
{value}
*NSET, NSET=FIX, INSTANCE=P-1
1, 4
*NSET, NSET=FIX, INSTANCE=P-2
2, 3
*NSET, NSET=OUT, INSTANCE=P-1
2,
*END ASSEMBLY
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*DENSITY
1.,
*BOUNDARY
FIX, ENCASTRE
*STEP, NAME=Step-1, NLGEOM=NO{more}
{procedure}
*END STEP
"""


def test_elements_of_the_assembly_name_nodes_of_instances(tmp_path: Path) -> None:
    """A spring between two instances, as CAE writes it; each bar has k = 25."""
    value = "*SPRING, ELSET=Springs/Dashpots-1\n1, 1\n1.E8"
    text = ASSEMBLY.format(
        type="SPRING2",
        nodes="1, P-1.2, P-2.1\n2, P-1.3, P-2.4",
        value=value,
        more="",
        procedure="*STATIC\n*CLOAD\nP-1.2, 1, 1.\nP-1.3, 1, 1.",
    )
    model = read(tmp_path, text)
    frame = ct.solve(model, threads=1).frames[-1]
    bar = 100.0 / 4.0
    assert frame.U[model.mesh.nodes_of("OUT")][0, 0] == pytest.approx(2.0 / (2.0 * bar), rel=1e-5)
    with pytest.raises(ct.DeckError, match=r"node P-2\.9 is not defined"):
        read(tmp_path, text.replace("P-2.4", "P-2.9"))


def test_inertia_of_the_assembly(tmp_path: Path) -> None:
    """Point masses at nodes of an instance, and the steps of CAE's frequency analysis."""
    text = ASSEMBLY.format(
        type="MASS",
        nodes="1, P-1.2\n2, P-1.3",
        value="*MASS, ELSET=Springs/Dashpots-1\n1000.,",
        more=", PERTURBATION",
        procedure="*FREQUENCY, EIGENSOLVER=Lanczos, NORMALIZATION=mass\n2, , , ,",
    )
    model = read(tmp_path, text)
    assert sum(m.mass for m in model.point_masses) in (1000.0, 2000.0)
    modes = ct.solve(model, threads=1).modes[-1]
    along = math.sqrt(25.0 / (2000.0 + 4.0 / 3.0)) / (2.0 * math.pi)
    assert np.abs(np.array(modes.factors) / along - 1.0).min() < 1e-2


def test_real_and_imaginary_loads_are_written_as_load_cases(tmp_path: Path) -> None:
    text = ASSEMBLY.format(
        type="MASS",
        nodes="1, P-1.2",
        value="*MASS, ELSET=Springs/Dashpots-1\n1.,",
        more=", PERTURBATION",
        procedure="*FREQUENCY\n3\n*END STEP\n*STEP, PERTURBATION\n"
        "*STEADY STATE DYNAMICS, FREQUENCY SCALE=LINEAR\n.1, .2, 3, 3.\n"
        "*CLOAD, REAL\nOUT, 1, 2.\n*CLOAD, IMAGINARY\nOUT, 2, -1.\n*RESTART, WRITE, "
        "NUMBER INTERVAL=1, TIME MARKS=NO, FREQUENCY=0",
    )
    model = read(tmp_path, text)
    step = model.steps[1]
    assert [len(step.loads), len(step.imaginary_loads)] == [1, 1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = ct.read(ct.write(model, tmp_path / "again.inp"))
    assert [s.nlgeom for s in again.steps] == [s.nlgeom for s in model.steps]
    assert [len(again.steps[1].loads), len(again.steps[1].imaginary_loads)] == [1, 1]
    with pytest.raises(ct.DeckError, match="IMAGINARY belongs to \\*STEADY STATE DYNAMICS"):
        read(
            tmp_path,
            text.replace("*FREQUENCY\n3\n", "*FREQUENCY\n3\n*CLOAD, IMAGINARY\nOUT, 2, 1.\n"),
        )


LOAD_CASES = """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=EA
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1.
{law}*SOLID SECTION, ELSET=EA, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
"""
CASES = (
    "*CLOAD\n2, 1, 1.\n3, 1, 1.\n",
    "*DLOAD\nEA, GRAV, 5., 0., -1.\n",
    "*BOUNDARY\n2, 1, 1, .01\n3, 1, 1, .01\n",
    "*CLOAD\n2, 2, -1.\n",
)


def load_case(loads: str) -> str:
    return f"*STEP, PERTURBATION\n*STATIC\n{loads}*END STEP\n"


def test_static_perturbations_are_load_cases(tmp_path: Path) -> None:
    """Each is the linear response to its own loads and supports, whatever was before."""
    head = LOAD_CASES.format(law="")
    results = ct.solve(read(tmp_path, head + "".join(map(load_case, CASES))), threads=1)
    for number, loads in enumerate(CASES, start=1):
        alone = ct.solve(read(tmp_path, head + load_case(loads)), threads=1).frames[-1]
        last = [frame for frame in results.frames if frame.step == number][-1]
        assert np.allclose(last.U, alone.U, rtol=1e-9, atol=1e-12)
        assert np.allclose(last.RF, alone.RF, rtol=1e-9, atol=1e-9)
    modes = "*STEP, PERTURBATION\n*FREQUENCY\n2\n*END STEP\n"
    loaded = ct.solve(read(tmp_path, head + load_case(CASES[0]) + modes), threads=1)
    plain = ct.solve(read(tmp_path, head + modes), threads=1)
    np.testing.assert_allclose(loaded.modes[-1].factors, plain.modes[-1].factors, rtol=1e-9)


@pytest.mark.parametrize(
    ("law", "steps", "said"),
    [
        ("", "*STEP\n*STATIC\n*CLOAD\n2, 1, 1.\n*END STEP\n" + load_case(CASES[0]), "loaded state"),
        ("", load_case(CASES[0]) + "*STEP\n*STATIC\n*END STEP\n", "another deck"),
        ("", load_case(CASES[0]) + "*STEP\n*DYNAMIC\n.1, .1\n*END STEP\n", "another deck"),
        ("*PLASTIC\n1., 0.\n2., .1\n", 2 * load_case(CASES[0]), "not linear"),
    ],
)
def test_perturbations_of_other_states_are_refused(
    tmp_path: Path, law: str, steps: str, said: str
) -> None:
    with pytest.raises(ct.DeckError, match=said):
        read(tmp_path, LOAD_CASES.format(law=law) + steps)


@pytest.mark.parametrize(
    "words", ["VISCOUS=FRACTION OF CRITICAL DAMPING", "DEFINITION=MODE NUMBERS"]
)
def test_modal_damping_in_the_words_of_abaqus(tmp_path: Path, words: str) -> None:
    """They say what is the default; other ones are refused."""
    motion = "*BASE MOTION, DOF=1, AMPLITUDE=A\n*MODAL DAMPING{}\n1, 1, .1"
    found = []
    for said in ("", f", {words}"):
        text = OSCILLATOR.format(procedure="*MODAL DYNAMIC\n.01, .5", motion=motion.format(said))
        found.append(ct.solve(read(tmp_path, text), threads=1).frames[-1].U)
    assert np.array_equal(found[0], found[1])
    other = motion.format(", VISCOUS=COMPOSITE")
    with pytest.raises(ct.DeckError, match="COMPOSITE is not known"):
        read(tmp_path, OSCILLATOR.format(procedure="*MODAL DYNAMIC\n.01, .5", motion=other))


@pytest.mark.parametrize(
    ("end", "load"), [("2., 0.", "PY, -3."), ("0., 2.", "PX, 3."), ("-2., 0.", "PY, 3.")]
)
def test_a_load_across_beams_of_abaqus(tmp_path: Path, end: str, load: str) -> None:
    """P2 acts to the left of the direction of a planar beam; CalculiX has a pressure there."""
    deck = f"""*PREPRINT, ECHO=NO
*NODE, NSET=NALL
1, 0., 0.
2, {end}
*ELEMENT, TYPE=B21, ELSET=E
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT
1., 1.
0., 0., -1.
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*DLOAD
E, {{load}}
*END STEP
"""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wanted = ct.solve(read(tmp_path, deck.format(load=load)), threads=1).frames[-1]
        found = ct.solve(read(tmp_path, deck.format(load="P2, -3.")), threads=1).frames[-1]
        assert np.abs(wanted.U).max() > 1e-3
        assert pytest.approx(wanted.U, rel=1e-12) == found.U
        assert pytest.approx(wanted.RF, rel=1e-12) == found.RF
        for old, new in (("*STEP", "*STEP, NLGEOM"), ("*PREPRINT, ECHO=NO\n", "")):
            with pytest.raises(ct.DeckError, match="PX and PY"):
                read(tmp_path, deck.format(load="P2, -3.").replace(old, new))
