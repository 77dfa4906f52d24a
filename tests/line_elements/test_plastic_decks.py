"""Decks of plastic trusses and beams: read, run, printed, written and read again."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

HINGE = Path(__file__).parents[2] / "docs" / "decks" / "hinge.inp"
SECTIONS = {
    "RECT": ("20., 10.", ct.profiles.rectangle(20.0, 10.0)),
    "CIRC": ("20., 10.", ct.profiles.circle(10.0, width=20.0)),
    "PIPE": ("5., 1.", ct.profiles.pipe(5.0, 1.0)),
    "BOX": ("20., 10., 1., 2., 3., 1.", ct.profiles.box(20.0, 10.0, (1.0, 2.0, 3.0, 1.0))),
    "I": (
        "5., 10., 8., 8., 1., 1., 0.5",
        ct.profiles.i_section(10.0, 8.0, 1.0, 0.5),
    ),
}


def deck(tmp_path: Path, section: str, axis: str = "") -> Path:
    text = HINGE.read_text()
    sizes = SECTIONS[section][0]
    if axis == "1., 0., 0.":
        # The first axis in the plane: bending is along it.
        values = sizes.split(",")
        sizes = ",".join([values[1], values[0], *values[2:]])
    text = text.replace("SECTION=RECT\n20., 10.", f"SECTION={section}\n{sizes}\n{axis}".rstrip())
    path = tmp_path / "hinge.inp"
    path.write_text(text)
    return path


@pytest.mark.parametrize("section", SECTIONS)
def test_sections_of_decks_are_those_of_profiles(section: str, tmp_path: Path) -> None:
    """And the fixed beam carries 8 M / L with the plastic moment M of its section."""
    profile = SECTIONS[section][1]
    model = ct.read(deck(tmp_path, section))
    own = model.sections[0]
    assert np.array(own.fibers) == pytest.approx(profile.fibers, abs=1e-9)
    expected = (profile.area, profile.inertia, profile.shear_area)
    assert own.profile == pytest.approx(expected, rel=1e-9)
    frame = ct.solve(model).frames[-1]
    limit = 8.0 * 250.0 * profile.plastic_modulus / 1000.0
    assert -frame.RF[1, 1] == pytest.approx(limit, rel=5e-3)


def test_an_unsymmetric_profile_follows_its_axes(tmp_path: Path) -> None:
    """The second axis points to the left, or to the right with the first axis along +z."""
    low, high = (
        np.array(ct.read(deck(tmp_path, "BOX", axis)).sections[0].fibers)[:, :2]
        for axis in ("0., 0., -1.", "0., 0., 1.")
    )
    assert low[:, 0] == pytest.approx(-high[::-1, 0], abs=1e-9)
    assert low[:, 1] == pytest.approx(high[::-1, 1], abs=1e-9)
    assert -low[0, 0] != pytest.approx(low[-1, 0], rel=1e-2)
    flat = ct.read(deck(tmp_path, "RECT", "1., 0., 0.")).sections[0]
    assert flat.profile[1] == pytest.approx(20.0 * 10.0**3 / 12.0, rel=1e-9)


def test_surfaces_are_printed_at_both_ends(tmp_path: Path) -> None:
    model = ct.read(deck(tmp_path, "RECT"))
    ct.solve(model, observers=[ct.JobFiles(tmp_path, name="job")], threads=1)
    text = (tmp_path / "job.dat").read_text()
    parts = {
        name: np.array(
            [[float(v) for v in line.split()] for line in part.splitlines()[1:] if line.strip()]
        )
        for name, part in (
            ("S", text.split("stresses")[-1].split("equivalent")[0]),
            ("PEEQ", text.split("equivalent plastic strain")[-1]),
        )
    }
    # Element, point, xx, ...: pulled on the left above the supports, on the right in the middle.
    stress = parts["S"][:, 2]
    assert parts["S"][:, 1].tolist() == [1, 2, 3, 4] * 2
    sign = [-1, 1, 1, -1, 1, -1, -1, 1]
    assert stress == pytest.approx(250.0 * np.array(sign), rel=1e-6)
    assert (parts["PEEQ"][:, 2] > 0.01).all()


def test_written_and_read_again(tmp_path: Path) -> None:
    model = ct.read(deck(tmp_path, "RECT"))
    ct.write(model, tmp_path / "again.inp")
    again = ct.read(tmp_path / "again.inp")
    assert np.array(again.sections[0].fibers) == pytest.approx(
        np.array(model.sections[0].fibers), rel=1e-9, abs=1e-12
    )
    with pytest.raises(ct.UnsupportedError, match="plastic beams"):
        ct.write(ct.read(deck(tmp_path, "PIPE")), tmp_path / "none.inp")


def test_a_truss_takes_a_yield_curve(tmp_path: Path) -> None:
    text = HINGE.read_text().replace("TYPE=B21", "TYPE=T2D2")
    text = text.replace(
        "*BEAM SECTION, ELSET=beam, MATERIAL=steel, SECTION=RECT\n20., 10.",
        "*SOLID SECTION, ELSET=beam, MATERIAL=steel\n3.",
    )
    text = text.replace("2, 2, 2, -50.", "2, 1, 1, 5.\n2, 2").replace("1, 1, 6", "1, 1, 2")
    text = text.replace("3, 1, 6", "3, 1, 2")
    path = tmp_path / "truss.inp"
    path.write_text(text)
    frame = ct.solve(ct.read(path)).frames[-1]
    assert frame.fields[0].values["N"].ravel() == pytest.approx([750.0, -750.0], rel=1e-9)


@pytest.mark.parametrize(
    ("material", "why"),
    [
        ("*HYPERELASTIC, NEO HOOKE\n1., 0.1", "beams take isotropic"),
        ("*POTENTIAL\n1., 1., 1., 1.2, 1., 1.", "beams take isotropic"),
    ],
)
def test_other_laws_are_refused(material: str, why: str, tmp_path: Path) -> None:
    text = HINGE.read_text()
    text = (
        text.replace("*ELASTIC\n200000., 0.3\n*PLASTIC\n250., 0.", material)
        if "HYPER" in material
        else text.replace("*PLASTIC\n250., 0.", "*PLASTIC\n250., 0.\n" + material)
    )
    path = tmp_path / "other.inp"
    path.write_text(text)
    with pytest.raises(ct.InputError, match=why):
        ct.read(path)
