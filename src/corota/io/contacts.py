"""Contact pairs in result files: the data for pictures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.datasets import store
from corota.model.contact import ContactPair, RigidCurve, edges_or_nodes

if TYPE_CHECKING:
    from corota.model.model import Model


def store_contacts(group: Any, model: Model) -> None:
    """Write surfaces and rigid curves of the contact pairs into an HDF5 group."""
    for number, pair in enumerate(model.contacts):
        own = group.create_group(str(number))
        own.attrs["name"] = pair.name
        edges, nodes = edges_or_nodes(model.mesh, pair.slave)
        store(own, "slave", nodes if len(nodes) else edges)
        if isinstance(pair.master, RigidCurve):
            store(own, "segments", pair.master.segments)
            if isinstance(pair.master.reference, int | np.integer):
                own.attrs["reference"] = int(pair.master.reference)
        else:
            store(own, "master", edges_or_nodes(model.mesh, pair.master)[0])


def contacts_of_results(file: Any) -> list[ContactPair]:
    """Contact pairs of a result file; none in those of versions without."""
    pairs = []
    group = file.get("contacts", {})
    for number in sorted(group, key=int):
        own = group[number]
        master: Any = own["master"][:] if "master" in own else None
        if master is None:
            reference = own.attrs.get("reference")
            master = RigidCurve(own["segments"][:], None if reference is None else int(reference))
        pairs.append(ContactPair(own["slave"][:], master, name=str(own.attrs["name"])))
    return pairs


__all__ = ["contacts_of_results", "store_contacts"]
