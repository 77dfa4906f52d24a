"""A geometrically linear step is linear, whatever the section and however large the load."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.models import ELEMENTS, cook


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_displacement_and_stress_are_proportional_to_the_load(element, local_strain):
    answers = []
    for force in (1e-6, 1e6):
        model, _ = cook(element, 2, force=force, local_strain=local_strain)
        frame = ct.solve(model, Static(nlgeom=False), threads=1).frames[-1]
        stress = np.concatenate([f.values["S"].ravel() for f in frame.fields])
        answers.append([frame.U / force, frame.RF / force, stress / force])
    for small, large in zip(*answers, strict=True):
        assert np.abs(small - large).max() <= 1e-11 * np.abs(small).max()


def test_all_local_strains_agree_in_a_linear_step():
    answers = []
    for local_strain in ("linear", "green_lagrange"):
        model, tip = cook("Q9", 4, local_strain=local_strain)
        answers.append(ct.solve(model, Static(nlgeom=False), threads=1).frames[-1].U[tip])
    assert (answers[0] == answers[1]).all()
