"""Install the peers: each that the Python package index gives in an environment of its own.

``python -m benchmarks.peers.install [NAME ...]`` puts them into ``$COROTA_PEERS``, or
``~/.cache/corota-peers``. CalculiX and DOLFINx come from the system's packages (Debian:
``calculix-ccx``, ``python3-dolfinx``); this says which of them are missing.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path


@dataclass(frozen=True)
class Peer:
    """A program to compare with: the module that shows it is there, what pip installs."""

    module: str
    packages: tuple[str, ...] = ()


PEERS = {
    "Kratos": Peer(
        "KratosMultiphysics",
        (
            "KratosMultiphysics",
            "KratosStructuralMechanicsApplication",
            "KratosLinearSolversApplication",
            "KratosConstitutiveLawsApplication",
            "KratosContactStructuralMechanicsApplication",
            "numpy",
        ),
    ),
    "Akantu": Peer("akantu", ("akantu", "numpy")),
    "DOLFINx": Peer("dolfinx"),
    "scikit-fem": Peer("skfem", ("scikit-fem", "scipy")),
    "FElupe": Peer("felupe", ("felupe", "scipy")),
    "OpenSeesPy": Peer("openseespy", ("openseespy", "numpy")),
}


def folder() -> Path:
    """Place of the environments."""
    return Path(os.environ.get("COROTA_PEERS") or Path.home() / ".cache" / "corota-peers")


@cache
def interpreter(name: str) -> Path | None:
    """Find a Python that can import a peer.

    Parameters
    ----------
    name : str
        A key of :data:`PEERS`.
    """
    places = [
        folder() / name.lower() / "bin" / "python",
        *(Path(found) for found in (shutil.which("python3"),) if found),
        Path("/usr/bin/python3"),
    ]
    for place in places:
        if place.exists():
            command = [str(place), "-c", f"import {PEERS[name].module}"]
            if subprocess.run(command, capture_output=True, check=False).returncode == 0:
                return place.absolute()
    return None


def install(name: str) -> bool:
    """Install one peer where it is not there yet; whether it is there afterwards."""
    if interpreter(name) is not None:
        return True
    packages = PEERS[name].packages
    if not packages:
        return False
    place = folder() / name.lower()
    python = place / "bin" / "python"
    for command in (
        [sys.executable, "-m", "venv", str(place)],
        [str(python), "-m", "pip", "install", "--quiet", *packages],
    ):
        if subprocess.run(command, check=False).returncode != 0:
            return False
    interpreter.cache_clear()
    return interpreter(name) is not None


def main() -> int:
    """Install those named, or all; the number of those missing."""
    missing = []
    for name in sys.argv[1:] or PEERS:
        sys.stdout.write(f"{name}: ")
        sys.stdout.flush()
        there = install(name)
        sys.stdout.write(f"{interpreter(name)}\n" if there else "missing\n")
        missing += [] if there else [name]
    if shutil.which("ccx") is None:
        sys.stdout.write("CalculiX (ccx): missing\n")
        missing.append("CalculiX")
    return len(missing)


if __name__ == "__main__":
    sys.exit(main())
