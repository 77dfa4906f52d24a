"""The model: plain data, valid or refused; no solver objects inside."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.model.dofs import DOFS
from corota.model.loads import (
    Amplitude,
    BodyForce,
    EdgeLoad,
    Fixed,
    Force,
    InitialStress,
    InitialTemperature,
    InitialVelocity,
    Load,
    NodalForce,
    Temperature,
)
from corota.model.model import Model
from corota.model.sections import Section

__all__ = [
    "DOFS",
    "Amplitude",
    "BodyForce",
    "EdgeLoad",
    "Fixed",
    "Force",
    "InitialStress",
    "InitialTemperature",
    "InitialVelocity",
    "Load",
    "Model",
    "NodalForce",
    "Section",
    "Temperature",
]
