"""Whether two runs left the same numbers, to the bit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import json
from pathlib import Path

import h5py
import numpy as np

from corota.results.observer import BaseObserver

#: Parts of records and files that tell of a run and not of its numbers.
OF_THE_RUN = ("elapsed", "profile", "run", "checksum")


class Takes(BaseObserver):
    """Observer that keeps the checkpoint of every increment."""

    checkpoint_due = True

    def __init__(self):
        self.found = []

    def checkpoint(self, checkpoint, keep=""):
        if not keep:
            self.found.append(checkpoint)


def frame_differences(one, other):
    """What differs between two frames, in words."""
    where = [(f.step, f.increment, f.time, f.step_time, f.factor) for f in (one, other)]
    found = [] if where[0] == where[1] else [f"{where[0]} and {where[1]}"]
    for name in ("U", "UR", "RF", "F", "V", "A", "C"):
        a, b = getattr(one, name), getattr(other, name)
        if (a is None) != (b is None) or (a is not None and a.tobytes() != b.tobytes()):
            found.append(f"{name} at {where[0]}")
    if repr(one.scalars) != repr(other.scalars):
        found.append(f"scalars at {where[0]}")
    for a, b in zip(one.fields, other.fields, strict=True):
        found += [
            f"{name} of points at {where[0]}"
            for name in a.values
            if a.values[name].tobytes() != b.values[name].tobytes()
        ]
    return found


def hdf_differences(one, other):
    """What differs between two HDF5 files: names, numbers and attributes."""
    found = []
    with h5py.File(one) as a, h5py.File(other) as b:
        names, others = [], []
        a.visit(names.append)
        b.visit(others.append)
        found += sorted(set(names) ^ set(others))
        for name in set(names) & set(others):
            x, y = a[name], b[name]
            if isinstance(x, h5py.Dataset) and x[()].tobytes() != y[()].tobytes():
                found.append(name)
            for key in set(x.attrs) - {"info", "run"}:
                if not np.array_equal(x.attrs[key], y.attrs.get(key)):
                    found.append(f"{name}.{key}")
    return found


def records(path):
    """Records of a file of JSON lines, without the times of the run."""
    rows = [json.loads(line) for line in Path(path).read_text().splitlines()]
    for row in rows:
        row.get("outcome", {}).pop("seconds", None)
    return [{k: v for k, v in row.items() if k not in OF_THE_RUN} for row in rows]


def table(path):
    """Rows of a CSV file, without the times of the rows of a sweep."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)]


def folder_differences(one, other):
    """What differs between the files of two runs; checkpoints do not count."""
    one, other = Path(one), Path(other)
    names, others = (
        {p.name for p in folder.iterdir() if "ckpt" not in p.name} for folder in (one, other)
    )
    found = sorted(names ^ others)
    for name in sorted(names & others):
        a, b = one / name, other / name
        if name.endswith("hdf"):
            found += [f"{name}: {part}" for part in hdf_differences(a, b)]
        elif name.endswith(".jsonl"):
            found += [name] if records(a) != records(b) else []
        elif name.endswith(".csv"):
            found += [name] if table(a) != table(b) else []
        elif a.read_bytes() != b.read_bytes():
            found.append(name)
    return found
