"""What the commands import: nothing that a small job does not use."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pkgutil
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import corota
from benchmarks.speed.start_time import ONE
from corota.arrays import distinct
from corota.io.deck import cards
from corota.io.deck.keywords import KEYWORDS
from corota.lazy import lazy

#: Runs a command, then prints what is loaded.
CHILD = """
import sys
from corota.cli import main
code = main(sys.argv[1:])
sys.stdout = sys.__stdout__
print("LOADED", *sorted(sys.modules))
sys.exit(code)
"""
#: Never needed to solve a static deck: each takes as long as solving it, or much longer.
HEAVY = {
    "IPython",
    "importlib.metadata",
    "matplotlib",
    "meshio",
    "multiprocessing",
    "numpy.ma",
    "numpy.random",
    "numpy.testing",
    "numpy.typing",
    "pandas",
    "pytest",
    "scipy",
    "setuptools",
    "sphinx",
    "tempfile",
}
#: Parts of Corota for other jobs.
OTHER_JOBS = {
    "corota.analysis.constraints.setup",
    "corota.analysis.linear.pardiso",
    "corota.analysis.linear.saddle_point",
    "corota.analysis.procedures.dynamic",
    "corota.analysis.procedures.path",
    "corota.analysis.procedures.stopping",
    "corota.analysis.terms.contact.equations",
    "corota.analysis.terms.contact.pair",
    "corota.analysis.terms.inertia",
    "corota.check",
    "corota.io.checkpoint",
    "corota.io.deck.build.contact",
    "corota.io.deck.cards.dynamic",
    "corota.io.deck.cards.plastic",
    "corota.io.deck.cards.tie",
    "corota.io.deck.write",
    "corota.io.gmsh",
    "corota.io.meshio_bridge",
    "corota.io.modes",
    "corota.io.tables.dat",
    "corota.io.unv",
    "corota.mesh.generate",
    "corota.plots",
    "corota.report",
    "corota.sweeps",
    "corota.verification",
}


def loaded(folder: Path, *words: str) -> set[str]:
    """Modules that a command loads."""
    run = subprocess.run(
        [sys.executable, "-c", CHILD, *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    return set(run.stdout.rsplit("LOADED ", 1)[1].split())


def test_the_help_loads_no_numerics(tmp_path: Path) -> None:
    found = loaded(tmp_path, "--help")
    assert {name for name in found if name.startswith("corota")} == {
        "corota",
        "corota.cli",
        "corota.cli.parser",
    }
    assert not found & {"numpy", "pathlib", "inspect", "tempfile", "logging", "json"}


def test_a_static_job_loads_what_it_uses(tmp_path: Path) -> None:
    (tmp_path / "one.inp").write_text(ONE, encoding="ascii")
    found = loaded(tmp_path, "run", "one.inp", "-q")
    assert (tmp_path / "one.vtkhdf").exists()
    assert not found & HEAVY
    assert not found & OTHER_JOBS


def test_solving_in_a_script_loads_no_files(tmp_path: Path) -> None:
    script = """
import corota as ct
model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
model.fix("left")
model.force("right", y=-0.01)
ct.solve(model, threads=1)
import sys
print("LOADED", *sorted(sys.modules))
"""
    run = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=True
    )
    found = set(run.stdout.rsplit("LOADED ", 1)[1].split())
    assert not found & HEAVY
    assert not found & {"h5py", "json", "corota.io.job", "corota.io.deck.read"}


def test_every_lazy_reference_has_its_function() -> None:
    """A table or a module refers to functions by text, which no type checker reads."""
    source = Path(corota.__file__).parent
    texts = {path: path.read_text(encoding="utf-8") for path in source.rglob("*.py")}
    places = [p for text in texts.values() for p in re.findall(r'\blazy\("([\w.]+:\w+)"\)', text)]
    assert len(places) > 20
    for place in places:
        module, _, name = place.partition(":")
        assert callable(getattr(import_module(module), name)), place


def test_every_card_enters_its_function() -> None:
    """The table knows keywords by the text of their modules, and loads a module at its card."""
    known = set(KEYWORDS)
    assert len(known) > 120
    assert all(callable(KEYWORDS[name].function) for name in known)
    for module in pkgutil.iter_modules(cards.__path__):
        import_module(f"{cards.__name__}.{module.name}")
    assert set(KEYWORDS) == known


@pytest.mark.parametrize("kind", [int, float, bool, str])
def test_distinct_values_are_those_of_numpy(kind: type) -> None:
    rng = np.random.default_rng(3)
    for size in (0, 1, 7, 400):
        values = rng.integers(0, 30, (size, 2)).astype(kind)
        found = distinct(values)
        assert found.dtype == values.dtype
        np.testing.assert_array_equal(found, np.unique(values))


def test_a_lazy_function_is_the_function() -> None:
    join = lazy("posixpath:join")
    assert join("a", "b") == "a/b"
    assert join.__name__ == "join"
    with pytest.raises(ModuleNotFoundError):
        lazy("no.such.module:function")()
