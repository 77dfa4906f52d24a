"""Pictures: contours on the deformed shape, curves, contact, the model, animations, motion.

All need matplotlib (``pip install corota[plot]``). Each function returns the figure; with ``path``
it is written too, as PNG, SVG or PDF by the ending.
"""

# SPDX-License-Identifier: BSD-3-Clause
from corota.plots.along import along
from corota.plots.animation import animate
from corota.plots.contact import contact_line, status
from corota.plots.contour import contour
from corota.plots.curves import curve
from corota.plots.figure import width_of
from corota.plots.forces import section_diagram, section_forces, section_history
from corota.plots.model import model
from corota.plots.motion import energies, modes, response
from corota.plots.principal import flow, principal
from corota.plots.sweep import sweep
from corota.plots.view import view

__all__ = [
    "along",
    "animate",
    "contact_line",
    "contour",
    "curve",
    "energies",
    "flow",
    "model",
    "modes",
    "principal",
    "response",
    "section_diagram",
    "section_forces",
    "section_history",
    "status",
    "sweep",
    "view",
    "width_of",
]
