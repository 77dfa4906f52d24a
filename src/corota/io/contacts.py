"""Contact pairs in result files: surfaces, rigid curves and settings."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.datasets import store
from corota.model.contact import ContactPair, PressureLaw, RigidCurve, edges_or_nodes
from corota.model.friction import DecayingFriction, Friction, FrictionTable

if TYPE_CHECKING:
    from corota.model.model import Model


def store_contacts(group: Any, model: Model) -> None:
    """Write surfaces and rigid curves of the contact pairs into an HDF5 group."""
    for number, pair in enumerate(model.contacts):
        own = group.create_group(str(number))
        own.attrs["name"] = pair.name
        own.attrs["settings"] = json.dumps(_settings(pair))
        own.attrs["sides"] = json.dumps([_name(pair.slave), _name(pair.master)])
        edges, nodes = edges_or_nodes(model.mesh, pair.slave)
        store(own, "slave", nodes if len(nodes) else edges)
        if isinstance(pair.master, RigidCurve):
            store(own, "segments", pair.master.segments)
            if isinstance(pair.master.reference, int | np.integer):
                own.attrs["reference"] = int(pair.master.reference)
                own.attrs["turns"] = pair.master.turns
        else:
            store(own, "master", edges_or_nodes(model.mesh, pair.master)[0])


def _settings(pair: ContactPair) -> dict[str, Any]:
    """Every setting of a pair that is a number, a word or its pressure law."""
    found = {item.name: getattr(pair, item.name) for item in fields(pair)}
    plain = {k: v for k, v in found.items() if isinstance(v, bool | int | float | str)}
    sides = ("name", "slave", "master")
    settings: dict[str, Any] = {k: v for k, v in plain.items() if k not in sides}
    if pair.steps is not None:
        settings["steps"] = list(pair.steps)
    if pair.law is not None:
        kind, pressure, overclosure = pair.law.constants
        settings["law"] = {"kind": kind, "pressure": pressure, "overclosure": overclosure}
    settings["friction"] = _friction(pair.friction)
    settings["friction_steps"] = {k: _friction(mu) for k, mu in pair.friction_steps.items()}
    return settings


def _friction(friction: Friction) -> Any:
    """A number, or the data of a coefficient that varies."""
    return vars(friction) if callable(friction) else friction


def _friction_of(stored: Any) -> Friction:
    """The coefficient of friction from what a file holds."""
    if not isinstance(stored, dict):
        return float(stored)
    return FrictionTable(**stored) if "rows" in stored else DecayingFriction(**stored)


def _name(side: Any) -> str:
    return side if isinstance(side, str) else str(getattr(side, "name", ""))


def contacts_of_results(file: Any) -> list[ContactPair]:
    """Contact pairs of a result file; none in those of versions without."""
    pairs = []
    group = file.get("contacts", {})
    for number in sorted(group, key=int):
        own = group[number]
        names = json.loads(own.attrs.get("sides", '["", ""]'))
        known = [name.replace("/", "|") in file["edge sets"] for name in names]
        slave: Any = names[0] if known[0] else own["slave"][:]
        if "master" in own:
            master: Any = names[1] if known[1] else own["master"][:]
        else:
            reference = own.attrs.get("reference")
            node = None if reference is None else int(reference)
            turns = bool(own.attrs.get("turns", True))
            master = RigidCurve(own["segments"][:], node, names[1], turns=turns)
        settings = json.loads(own.attrs.get("settings", "{}"))
        if "law" in settings:
            settings["law"] = PressureLaw(**settings["law"])
        settings["friction"] = _friction_of(settings.get("friction", 0.0))
        steps = settings.get("friction_steps", {})
        settings["friction_steps"] = {int(k): _friction_of(mu) for k, mu in steps.items()}
        pairs.append(ContactPair(slave, master, name=str(own.attrs["name"]), **settings))
    return pairs
