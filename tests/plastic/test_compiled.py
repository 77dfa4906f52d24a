"""Compiled laws of users, UMAT and the C interface, against laws of the core."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.check.material import check_material
from corota.cli import main
from corota.verification.models import cell
from support.compiled import SOURCE, build, compiled_laws

STEEL = (200e3, 0.3, 250.0, 2e3)
RUBBER = (0.5, 0.02)
#: Relative difference of the same law, iterated to another rounding.
ROUNDING = 1e-9


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_laws(tmp_path_factory.mktemp("laws"))


def steel(library: Path) -> ct.Umat:
    return ct.Umat(library, STEEL, 5, name="steel")


def rubber(library: Path) -> ct.Umat:
    return ct.Umat(library, RUBBER, terms="gradient", name="rubber")


def beam(material: Any, element: str, plane: str, nlgeom: bool = True, push: float = 1.5) -> Any:
    """A cantilever of 10 by 2, its end pushed aside: sum of the reactions and last stresses."""
    model = ct.Model(ct.mesh.rectangle(10.0, 2.0, 8, 2, cell(element)))
    model.section("all", element=element, material=material, plane=plane)
    model.fix("left", x=0.0, y=0.0)
    model.fix("right", y=push)
    found = ct.solve(model, ct.Static(nlgeom=nlgeom, increments=3), threads=1)
    frame = found.frames[-1]
    forces = np.array([f.RF[found.model.mesh.nodes_of("right")].sum(axis=0) for f in found.frames])
    return forces, frame.fields[0].values["S"], found


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8R", "Q4S", "T6", "Q4D"])
def test_a_umat_in_small_displacements_is_the_law_of_the_core(library: Path, element: str) -> None:
    """All elements, those with internal modes included, with plastic flow in plane strain."""
    core = ct.Mises(E=STEEL[0], nu=STEEL[1], yield_stress=STEEL[2], isotropic=STEEL[3])
    wanted, stress, _ = beam(core, element, "strain", nlgeom=False, push=0.1)
    forces, found, _ = beam(steel(library), element, "strain", nlgeom=False, push=0.1)
    assert forces == pytest.approx(wanted, rel=ROUNDING, abs=1e-6)
    assert found == pytest.approx(stress, rel=1e-6, abs=1e-6)


def test_flow_of_a_umat_takes_the_iterations_of_the_core(library: Path) -> None:
    """At plastic strains of some tenths: increments begin with the tangent of further flow."""
    core = ct.Mises(E=STEEL[0], nu=STEEL[1], yield_stress=STEEL[2], isotropic=STEEL[3])
    counts = []
    for material in (core, steel(library)):
        model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 10, 2, "quad8"))
        model.section("all", element="Q8R", material=material, plane="strain")
        model.fix("left")
        model.fix("right", x=None, y=-3.0)
        frames = ct.solve(model, ct.Static(increments=20), threads=1).frames
        counts.append(sum(frame.scalars["iterations"] for frame in frames[1:]))
    assert counts[1] <= 1.15 * counts[0]


@pytest.mark.parametrize("element", ["Q4", "Q8R", "Q4S"])
def test_a_umat_in_terms_of_the_gradient_is_neo_hooke(library: Path, element: str) -> None:
    """Large strain and rotation; stress and rate of Jaumann against the law of the core."""
    wanted, stress, one = beam(ct.NeoHooke(*RUBBER), element, "strain", push=6.0)
    forces, found, other = beam(rubber(library), element, "strain", push=6.0)
    assert forces == pytest.approx(wanted, rel=1e-7, abs=1e-7)
    assert found == pytest.approx(stress, rel=1e-6, abs=1e-7)
    # An exact tangent takes as many iterations, but for rounding.
    assert abs(one.info["iterations"] - other.info["iterations"]) <= 1


def test_stress_of_a_umat_is_cauchy_stress(library: Path) -> None:
    """Uniaxial strain of 10 %: STRESS = C : STRAN is what the results give, not J times it."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    stiff = ct.Umat(library, (1000.0, 0.3, 1e9, 0.0), 5, name="steel")
    model.section("all", element="Q4", material=stiff, plane="strain")
    for side, x in (("left", 0.0), ("right", 0.1)):
        model.fix(side, x=x, y=0.0)
    found = ct.solve(model, ct.Static(), threads=1).frames[-1].fields[0].values
    modulus = 1000.0 * 0.7 / (1.3 * 0.4)
    assert found["S"][..., 0] == pytest.approx(modulus * np.log(1.1), rel=1e-9)
    assert found["SDV1"] == pytest.approx(0.0)


def test_a_short_increment_that_a_umat_wants_is_taken(library: Path) -> None:
    limited = ct.Umat(library, (1000.0, 0.3, 1e9, 0.0), 5, name="limited")
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=limited)
    model.fix("left", x=0.0, y=0.0)
    model.fix("right", x=0.0025)
    found = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    assert len(found.frames) > 3


def test_compiled_laws_are_checked(library: Path) -> None:
    for law, size in ((steel(library), None), (rubber(library), 0.4)):
        found = check_material(law, "strain", size)
        assert found.faults == []
        assert found.tangent < 1e-7
        assert found.energy is not None
    wrong = ct.Umat(library, RUBBER, terms="strain", name="rubber")
    assert "not the derivative" in check_material(wrong, "strain", 0.4).faults[0]


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_a_function_with_the_c_interface(library: Path, plane: str) -> None:
    """By a ctypes function and by its address; threads and lanes change nothing."""
    function = ctypes.CDLL(str(library)).elastic
    address = ctypes.cast(function, ctypes.c_void_p).value
    nu = 0.3
    if plane == "strain":
        a, b = 1000.0 * (1 - nu) / (1.3 * 0.4), 1000.0 * nu / (1.3 * 0.4)
    else:
        a, b = 1000.0 / (1 - nu**2), 1000.0 * nu / (1 - nu**2)
    core = ct.Elastic(1000.0, nu)
    for given in (function, address):
        law = ct.CompiledMaterial(given, (a, b), 1)
        assert check_material(law, plane).faults == []
        forces, _, found = beam(law, "Q4I", plane)
        model = found.model.sections[0]
        assert model.local_strain == "logarithmic"
        wanted = ct.Model(ct.mesh.rectangle(10.0, 2.0, nx=8, ny=2))
        wanted.section("all", element="Q4I", material=core, plane=plane, local_strain="logarithmic")
        wanted.fix("left", x=0.0, y=0.0)
        wanted.fix("right", y=1.5)
        exact = ct.solve(wanted, ct.Static(increments=3), threads=2)
        right = wanted.mesh.nodes_of("right")
        assert forces[-1] == pytest.approx(exact.frames[-1].RF[right].sum(axis=0), rel=1e-8)
        history = found.frames[-1].fields[0].values
        assert history["SDV1"].max() == pytest.approx(history["E"][..., 0].max(), rel=0.5)


def deck(folder: Path, material: str) -> Path:
    path = folder / "bar.inp"
    path.write_text(
        "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n"
        f"{material}*SOLID SECTION, ELSET=E, MATERIAL=steel\n1.\n*STEP\n*STATIC\n*BOUNDARY\n"
        "1, 1, 2\n4, 1\n2, 1, 1, 0.01\n3, 1, 1, 0.01\n*EL PRINT, ELSET=E\nS\n*END STEP\n"
    )
    return path


UMAT = "*MATERIAL, NAME=steel\n*USER MATERIAL, CONSTANTS=4\n2e5, .3, 250., 2000.\n*DEPVAR\n5\n"


def test_no_deck_loads_a_library_by_itself(
    tmp_path: Path, library: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = deck(tmp_path, UMAT)
    assert main(["run", str(path), "-o", str(tmp_path)]) == 2
    assert "--allow-library" in capsys.readouterr().err
    assert main(["run", str(path), "-o", str(tmp_path), "--allow-library", str(library)]) == 0
    assert (
        main(["check-material", str(path), "--plane", "strain", "--allow-library", str(library)])
        == 0
    )
    missing = tmp_path / "none.so"
    assert main(["run", str(path), "--allow-library", str(missing)]) == 6
    empty = tmp_path / "empty.so"
    empty.write_text("no library")
    assert main(["run", str(path), "--allow-library", str(empty)]) == 6
    capsys.readouterr()


def test_cards_of_user_materials(tmp_path: Path, library: Path) -> None:
    model = ct.read(deck(tmp_path, UMAT), library=library)
    law = model.sections[0].material
    assert isinstance(law, ct.Umat)
    assert (list(law.constants), law.states, law.name) == ([2e5, 0.3, 250.0, 2000.0], 5, "steel")
    for wrong, message in (
        (UMAT.replace("CONSTANTS=4", "CONSTANTS=12"), "CONSTANTS= is the number"),
        (UMAT.replace("*DEPVAR\n5", "*DEPVAR\n-1"), "a whole number"),
        (UMAT + "*PLASTIC\n250., 0.\n", "stands alone"),
        (UMAT.replace("*USER", "*ELASTIC\n2e5, .3\n*USER"), "already has constants"),
    ):
        with pytest.raises(ct.DeckError, match=message):
            ct.read(deck(tmp_path, wrong), library=library)


def test_a_checkpoint_names_no_code(tmp_path: Path, library: Path) -> None:
    """Neither a library nor an address is taken from a file: the model must be given again."""
    model = ct.read(deck(tmp_path, UMAT), library=library)
    files = ct.JobFiles(tmp_path, "bar", checkpoint_every=1)
    with files:
        ct.solve(model, observers=[files], threads=1)
    with pytest.raises(ct.FileError, match="give it"):
        ct.resume(tmp_path / "bar")


def test_wrong_functions_are_refused(library: Path, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="function must be an address"):
        ct.CompiledMaterial("elastic")
    other = tmp_path / "other.so"
    text = SOURCE.read_text().replace("void umat_(", "void other_law(")
    build(text, other)
    with pytest.raises(ct.InputError, match="no subroutine UMAT"):
        ct.Umat(other)
    with pytest.raises(ct.InputError, match="terms"):
        ct.Umat(library, terms="both")  # type: ignore[arg-type]
