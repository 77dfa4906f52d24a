"""Mesh ``gripper.geo`` with Gmsh into the package's ``gripper.msh``, and into a deck's mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import tempfile
from pathlib import Path

import gmsh

HERE = Path(__file__).resolve().parent


def tidy(line: str) -> str:
    """Coordinates of a node line to nine digits; other lines as they are."""
    fields = line.split(", ")
    if len(fields) != 4 or "." not in line:
        return line
    return ", ".join([fields[0], *(f"{float(x):.9g}" for x in fields[1:])])


def main() -> None:
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.open(str(HERE / "gripper.geo"))
    gmsh.model.mesh.generate(2)
    gmsh.write(str(HERE.parents[1] / "src" / "corota" / "examples" / "gripper.msh"))
    # As decks want it: node sets of points and curves, element sets of surfaces.
    gmsh.option.setNumber("Mesh.SaveGroupsOfNodes", -11)
    gmsh.option.setNumber("Mesh.SaveGroupsOfElements", -100)
    with tempfile.TemporaryDirectory() as folder:
        export = Path(folder) / "mesh.inp"
        gmsh.write(str(export))
        lines = export.read_text(encoding="ascii").splitlines()
    gmsh.finalize()
    # Without the heading, which is a path; the deck that includes the mesh has its own.
    # Gmsh knows CPS4 only; the deck asks for the incompatible modes, which bend without locking.
    body = [tidy(line).replace("type=CPS4,", "type=CPS4I,") for line in lines[2:]]
    (HERE / "gripper_mesh.inp").write_text("\n".join(body) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
