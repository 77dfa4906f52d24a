"""`corota check-material`: good laws have no fault, and each kind of fault is named."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.check.material import check_material
from corota.cli import main

C = np.array([[1000.0, 300.0, 0.0], [300.0, 1000.0, 0.0], [0.0, 0.0, 350.0]])
GOOD = {
    "isotropic": ct.Mises(E=200e3, nu=0.3, yield_stress=250.0, isotropic=2e3),
    "recall": ct.Mises(E=70e3, nu=0.33, yield_stress=200.0, chaboche=[(5e3, 50.0)]),
    "sheet": ct.Hill(E=200e3, nu=0.3, yield_stress=200.0, isotropic=1e3, R22=1.1),
    "rubber": ct.Yeoh(C10=0.4, C20=-0.01, C30=0.002, D1=0.002),
    "polymer": ct.Viscoelastic(ct.Elastic(E=2e3, nu=0.38), terms=[(0.3, 0.1, 0.4)]),
}


def linear(matrix: Any, tangent: Any = None, energy: float | None = None) -> ct.UserMaterial:
    given = matrix if tangent is None else tangent

    def law(strain: Any, state: Any, plane: str) -> Any:
        stress = strain @ matrix.T
        answer = (stress, np.broadcast_to(given, (*strain.shape, 3)), state)
        if energy is None:
            return answer
        return (*answer, {"energy": energy * (strain * stress).sum(axis=-1)})

    return ct.UserMaterial(law)


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", GOOD)
def test_laws_of_the_core_have_no_fault(name: str, plane: str) -> None:
    found = check_material(GOOD[name], plane)
    assert found.faults == []
    assert found.tangent < 1e-6
    assert (found.objectivity is None) == (name == "sheet")
    # Dynamic recovery is the one whose derivative is not symmetric.
    assert (found.asymmetry > 1e-4) == (name == "recall")


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (linear(C, energy=0.5), ""),
        (linear(C, tangent=1.2 * C), "not the derivative"),
        (linear(np.diag([1000.0, 800.0, 350.0])), "does not turn"),
        (linear(C, energy=0.6), "not the work of the stress"),
    ],
)
def test_faults_are_named(law: ct.UserMaterial, fault: str) -> None:
    found = check_material(law)
    assert len(found.faults) == bool(fault)
    assert fault in " ".join(found.faults)


def test_a_law_that_does_not_repeat_or_heals_is_named() -> None:
    """Stress that drifts with every call, and a plastic strain that follows the strain."""
    calls = []

    def odd(strain: Any, state: Any, plane: str) -> Any:
        calls.append(strain)
        stress = strain @ C.T + 1e-9 * len(calls)
        given = np.broadcast_to(C, (*strain.shape, 3))
        return stress, given, state, {"PEEQ": np.abs(strain).max(axis=-1)}

    found = check_material(ct.UserMaterial(odd))
    assert found.faults[-2:] == [
        "the same strain path gives different stresses",
        "PEEQ falls along a path",
    ]


def test_a_law_that_makes_energy_is_named() -> None:
    """Stress that runs ahead of a turning strain: an antisymmetric part does work in a cycle."""
    spinning = C + np.array([[0.0, 0.0, -200.0], [0.0, 0.0, 0.0], [200.0, 0.0, 0.0]])
    both = [check_material(linear(m)).created for m in (spinning, spinning.T)]
    assert min(both) < 1e-12
    assert max(both) > 0.1


def test_the_command_reads_decks_and_python_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / "laws.py"
    file.write_text(
        "import corota as ct\n"
        "steel = ct.Mises(E=200e3, nu=0.3, yield_stress=250.0)\n"
        "def twice(e, s, p):\n"
        "    import numpy as np\n"
        "    return e, np.broadcast_to(2.0 * np.eye(3), (*e.shape, 3)), s\n"
        "wrong = ct.UserMaterial(twice)\n"
    )
    picture = tmp_path / "laws.png"
    assert main(["check-material", str(file), "--name", "steel", "--plot", str(picture)]) == 0
    assert picture.stat().st_size > 5_000
    assert "steel, plane strain: tangent" in capsys.readouterr().out
    assert main(["check-material", str(file), "--json", "--plane", "stress"]) == 3
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    faults = {r["name"]: r["faults"] for r in rows if r.get("event") == "material"}
    assert faults["steel"] == []
    assert "not the derivative" in " ".join(faults["wrong"])
    deck = Path(__file__).parents[2] / "docs" / "decks" / "sheet.inp"
    assert main(["check-material", str(deck), "--plane", "stress"]) == 0
    assert main(["check-material", str(file), "--name", "none"]) == 2
