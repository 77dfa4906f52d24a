"""Names of the local strain measures, and the advice which one to take."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import pytest

import corota as ct
from corota.io import formats

ELASTIC = ct.Elastic(E=70.0, nu=0.3)
FLOWING = ct.Mises(E=70.0, nu=0.3, yield_stress=0.243, isotropic=0.1)


def strip(material, strain, stretch=0.05):
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2))
    model.section("all", element="Q4I", material=material, local_strain=strain)
    model.fix("left")
    model.fix("right", x=2.0 * stretch, y=None)
    return model


def last(model):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, ct.Static(), threads=1).frames[-1]


@pytest.mark.parametrize(("alias", "name"), [("simplified", "linear"), ("modified", "logarithmic")])
def test_the_papers_names_stand_for_the_measures(alias, name):
    assert strip(FLOWING, alias).sections[0].local_strain == name
    assert (last(strip(FLOWING, alias)).U == last(strip(FLOWING, name)).U).all()


def test_the_three_measures_differ_where_strain_is_large():
    ends = {n: last(strip(ELASTIC, n, 0.2)).RF[:, 0].max() for n in ct.LOCAL_STRAINS}
    assert ends["green_lagrange"] > 1.05 * ends["linear"] > 1.05**2 * ends["logarithmic"]


def test_green_lagrange_is_refused_where_the_material_flows():
    with pytest.raises(ct.InputError, match="local_strain='logarithmic'"):
        strip(FLOWING, "green_lagrange")


@pytest.mark.parametrize(("wrong", "meant"), [("log", "logarithmic"), ("greenlagrang", "green")])
def test_an_unknown_name_is_refused_with_the_nearest(wrong, meant):
    with pytest.raises(ct.InputError, match=f"did you mean '{meant}"):
        strip(ELASTIC, wrong)


@pytest.mark.parametrize(
    ("spelled", "name"),
    [
        ("LINEAR", "linear"),
        ("SIMPLIFIED", "linear"),
        ("LOGARITHMIC", "logarithmic"),
        ("MODIFIED", "logarithmic"),
        ("Green Lagrange", "green_lagrange"),
    ],
)
def test_decks_take_the_names_and_keep_them(spelled, name, tmp_path):
    path = tmp_path / "deck.inp"
    formats.write(strip(ELASTIC, "logarithmic"), path)
    path.write_text(path.read_text().replace("LOCAL STRAIN=LOGARITHMIC", f"LOCAL STRAIN={spelled}"))
    model = ct.read(path)
    assert model.sections[0].local_strain == name
    formats.write(model, path)
    assert ct.read(path).sections[0].local_strain == name


@pytest.mark.parametrize(
    ("material", "advised"),
    [
        (ELASTIC, "green_lagrange"),
        (FLOWING, "use local_strain='logarithmic' to follow Abaqus and for materials that flow"),
    ],
)
def test_large_strain_under_the_linear_measure_is_said_once_with_the_remedy(material, advised):
    model = strip(material, "linear", 0.1)
    with pytest.warns(UserWarning, match="local strain reaches") as caught:
        results = ct.solve(model, ct.Static(increments=4), threads=1)
    reported = [str(w.message) for w in caught if "local strain reaches" in str(w.message)]
    assert len(reported) == 1
    assert advised in reported[0]
    # The largest value of all increments, once, at the end.
    assert f"step 1, increment {results.frames[-1].increment}, under" in reported[0]
    assert results.notes.count(reported[0]) == 1
