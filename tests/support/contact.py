"""What tests of contact share."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np

CELLS = {
    "T3": "tri3",
    "OPT": "tri3",
    "T6": "tri6",
    "Q4": "quad4",
    "Q4I": "quad4",
    "Q4D": "quad4",
    "Q8": "quad8",
    "Q8R": "quad8",
    "Q9": "quad9",
}


def stresses(results, turn):
    """Stress at all points in the axes of the interface, shape (n, 3): along, across, shear."""
    s = np.concatenate([b.values["S"].reshape(-1, 4) for b in results.frames[-1].fields])
    full = np.array([[s[:, 0], s[:, 3]], [s[:, 3], s[:, 1]]])
    local = np.einsum("ji,jkn,kl->iln", turn, full, turn)
    return np.column_stack([local[0, 0], local[1, 1], local[0, 1]])
