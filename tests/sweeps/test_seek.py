"""Goal seek: few runs, the right value, stored runs, failures by name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys

import pytest

import corota as ct
from corota.errors import CorotaError, InputError


def cantilever(depth):
    """A beam of length 10, E = 1000: its tip moves by 4 P L^3 / (E t depth^3)."""
    model = ct.Model(ct.mesh.rectangle(10.0, depth, nx=20, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.force("right", y=-0.001)
    return model, ct.Static(nlgeom=False)


def test_the_depth_of_a_cantilever():
    # Bending and shear of a beam of depth 0.5, of which the clamp takes 0.1 %.
    target = -(4.0 * 0.001 * 1e3 / (1000.0 * 0.5**3) + 1.2 * 0.001 * 10.0 / (500.0 * 0.5))
    found = ct.seek(cantilever, {"depth": (0.2, 2.0)}, "last(U2@right)", target)
    assert found.value == pytest.approx(0.5, rel=2e-3)
    assert found.measure == pytest.approx(target, rel=1e-4)
    assert len(found.runs) <= 14
    assert str(found).startswith("depth = 0.49")


def test_stored_runs_are_not_repeated(tmp_path):
    count = 0

    def counted(depth):
        nonlocal count
        count += 1
        return cantilever(depth)

    arguments = (counted, {"depth": (0.2, 2.0)}, "last(U2@right)", -0.01)
    first = ct.seek(*arguments, store=tmp_path / "runs.jsonl")
    runs = count
    second = ct.seek(*arguments, store=tmp_path / "runs.jsonl")
    assert count == runs
    assert second.value == first.value


def test_a_target_outside_of_the_range_is_named():
    with pytest.raises(InputError, match=r"both on one side of the target 5; widen the range"):
        ct.seek(cantilever, {"depth": (0.5, 1.0)}, "last(U2@right)", 5.0)


def test_a_failed_run_is_named():
    def broken(depth):
        raise InputError("no mesh")

    with pytest.raises(CorotaError, match=r"depth = 0\.5 failed: no mesh"):
        ct.seek(broken, {"depth": (0.5, 1.0)}, "last(U2@right)", 5.0)


@pytest.mark.parametrize(
    "parameter", [{"a": (2.0, 1.0)}, {"a": 1.0}, {}, {"a": (0, 1), "b": (0, 1)}]
)
def test_a_search_has_one_range(parameter):
    with pytest.raises(InputError):
        ct.seek(cantilever, parameter, "last(U2@right)", 5.0)


def test_the_command(tmp_path):
    deck = tmp_path / "bar.inp"
    deck.write_text(
        "*PARAMETER\nt = 1.\n*NODE, NSET=N\n1, 0, 0\n2, 2, 0\n3, 2, 1\n4, 0, 1\n"
        "*ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n<t>\n*BOUNDARY\n1, 1, 2\n4, 1, 2\n*STEP\n*STATIC\n"
        "*CLOAD\n2, 1, 1.\n3, 1, 1.\n*NODE PRINT, NSET=N\nU\n*END STEP\n"
    )
    command = [sys.executable, "-m", "corota", "seek", "bar.inp", "-p", "t=0.1:4"]
    command += ["-m", "last(U1@2)", "--target", "0.008", "--tolerance", "1e-8"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False
    )
    # u = F L / (E A): 2 * 2 / (1000 t)
    assert done.returncode == 0, done.stderr
    assert "t = 0.5:" in done.stdout
