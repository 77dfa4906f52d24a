"""A stage as a nonlinear spring: tables that multibody programs and decks read."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np

from corota.errors import InputError
from corota.io.atomic_file import replace_text
from corota.results.measures import COMPONENTS
from corota.results.stage_results import STILL, StageResults

#: Dofs of the components in decks, and their names.
DOFS = {"x": 1, "y": 2, "rotation": 6}


def write_spring(stage: StageResults, path: Path) -> Path:
    """Write force against motion of a stage; return the path.

    ``.csv`` has a row for each frame: motion x, motion y, rotation, force x, force y, moment, and
    the nine entries of the tangent stiffness, for splines and bushings of multibody programs.
    ``.inp`` has three springs to the ground, ``*SPRING, NONLINEAR`` for each component that moves
    in one direction, and ``*SPRING`` with the stiffness of the first frame for the others; the
    springs do not couple.

    Raises
    ------
    InputError
        If the ending is another one, or no component moves in one direction only.
    FileError
        If the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix == ".csv":
        text = _table(stage)
    elif suffix == ".inp":
        text = _cards(stage)
    else:
        raise InputError(f"{path}: the table of a spring is .csv or .inp")
    replace_text(path, text)
    return path


def _table(stage: StageResults) -> str:
    names = ["motion x", "motion y", "rotation", "force x", "force y", "moment"]
    names += [f"stiffness {a}{b}" for a in COMPONENTS for b in COMPONENTS]
    columns = [stage.motion, stage.force, stage.stiffness.reshape(-1, 9)]
    rows = np.concatenate(columns, axis=1)
    lines = [",".join(names), *(",".join(f"{v:.12g}" for v in row) for row in rows)]
    return "\n".join(lines) + "\n"


def _cards(stage: StageResults) -> str:
    lines = [
        f"** Stage {stage.name}: springs to the ground at its reference point",
        "** Give the set STAGE the number of a node there.",
    ]
    size = np.abs(stage.motion).max(axis=0)
    nonlinear = 0
    for k, (name, dof) in enumerate(DOFS.items()):
        travel, load = stage.motion[:, k], stage.force[:, k]
        order = np.argsort(travel)
        moved = np.diff(travel)
        one_way = len(moved) > 0 and ((moved > 0.0).all() or (moved < 0.0).all())
        lines.append(f"*ELEMENT, TYPE=SPRING1, ELSET=STAGE_{name.upper()}")
        lines.append(f"{9001 + k}, <stage>")
        if one_way and size[k] > STILL * max(size[: 2 if k < 2 else 3].max(), 1e-300):
            nonlinear += 1
            lines.append(f"*SPRING, ELSET=STAGE_{name.upper()}, NONLINEAR")
            lines.append(f"{dof}")
            lines += [f"{load[i]:.12g}, {travel[i]:.12g}" for i in order]
            continue
        constant = stage.stiffness[0, k, k]
        if not np.isfinite(constant):
            raise InputError(
                f"stage {stage.name!r} does not move along {name}, and has no stiffness there"
            )
        lines += [f"*SPRING, ELSET=STAGE_{name.upper()}", f"{dof}", f"{constant:.12g}"]
    if not nonlinear:
        raise InputError(
            f"stage {stage.name!r}: each component goes back and forth; write the .csv, or end the "
            "step before the motion turns"
        )
    return "\n".join(lines) + "\n"
