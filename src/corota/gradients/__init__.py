"""Exact gradients of measures of an analysis: adjoint method, and optimization with it."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.gradients.critical import BifurcationLoad, Frequency, LimitLoad
from corota.gradients.density import Density, optimize_density
from corota.gradients.measures import (
    Area,
    Displacement,
    LoadFactor,
    Mass,
    Measure,
    Reaction,
    StrainEnergy,
    Stress,
    Velocity,
    Width,
)
from corota.gradients.optimization import Constraint, Design, Optimum, optimize
from corota.gradients.page import write_page
from corota.gradients.parameters import (
    Attribute,
    Constant,
    Orientation,
    Parameter,
    Positions,
    Shape,
    Thickness,
)
from corota.gradients.reanalysis import Reanalysis, reanalyze
from corota.gradients.runs import Run, ValueAndGradient, gradient, value_and_grad
from corota.gradients.shaping import ShapeDesign, shape

__all__ = [
    "Area",
    "Attribute",
    "BifurcationLoad",
    "Constant",
    "Constraint",
    "Density",
    "Design",
    "Displacement",
    "Frequency",
    "LimitLoad",
    "LoadFactor",
    "Mass",
    "Measure",
    "Optimum",
    "Orientation",
    "Parameter",
    "Positions",
    "Reaction",
    "Reanalysis",
    "Run",
    "Shape",
    "ShapeDesign",
    "StrainEnergy",
    "Stress",
    "Thickness",
    "ValueAndGradient",
    "Velocity",
    "Width",
    "gradient",
    "optimize",
    "optimize_density",
    "reanalyze",
    "shape",
    "value_and_grad",
    "write_page",
]
