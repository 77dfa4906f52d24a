"""A chunk: a header and arrays, deflated, for the page and the server.

Before it is deflated a chunk is four bytes with the length of the header, the header as JSON, and
the bytes of the arrays. Bytes of equal weight of an array are contiguous: the first bytes of all
numbers, then the second ones. Little-endian.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import math
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.events import plain

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

#: Number types supported by the page.
TYPES: dict[str, np.dtype[Any]] = {
    "f4": np.dtype("<f4"),
    "f8": np.dtype("<f8"),
    "i4": np.dtype("<i4"),
}


def pack(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], level: int = 9) -> bytes:
    """Deflate a header and arrays.

    Parameters
    ----------
    header : mapping
        Plain data; a number that is not finite becomes ``null``.
    arrays : mapping of str to ndarray
        Of ``float32``, ``float64`` or integers that fit 32 bits.
    level : int
        Of zlib.
    """
    known = []
    parts = []
    for name, array in arrays.items():
        kind = "i4" if array.dtype.kind in "iub" else "f8" if array.dtype == np.float64 else "f4"
        known.append({"name": name, "type": kind, "shape": list(array.shape)})
        flat = np.ascontiguousarray(array, TYPES[kind]).reshape(-1)
        parts.append(flat.view(np.uint8).reshape(-1, TYPES[kind].itemsize).T.tobytes())
    head = json.dumps(
        plain({**header, "arrays": known}), allow_nan=False, separators=(",", ":")
    ).encode()
    return zlib.compress(b"".join([len(head).to_bytes(4, "little"), head, *parts]), level)


def unpack(data: bytes) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of a chunk."""
    raw = zlib.decompress(data)
    at = 4 + int.from_bytes(raw[:4], "little")
    header: dict[str, Any] = json.loads(raw[4:at])
    arrays = {}
    for item in header.pop("arrays"):
        kind = TYPES[item["type"]]
        size = math.prod(item["shape"]) * kind.itemsize
        planes = np.frombuffer(raw[at : at + size], np.uint8).reshape(kind.itemsize, -1)
        arrays[item["name"]] = np.ascontiguousarray(planes.T).view(kind).reshape(item["shape"])
        at += size
    return header, arrays


def rounded(values: NDArray[Any], bits: int = 14) -> NDArray[np.float32]:
    """Single precision with so many bits behind the point; zero stays zero.

    The relative error is ``2**-(bits + 1)``: 14 bits keep four and a half decimal digits, and the
    two bytes that are mostly zero deflate to little.
    """
    single = np.ascontiguousarray(values, dtype=np.float32)
    whole = single.view(np.uint32)
    drop = 23 - bits
    half = np.uint32(1 << (drop - 1))
    kept = (whole + half) & ~np.uint32((1 << drop) - 1)
    # Rounding up must not overflow the largest numbers.
    out: NDArray[np.float32] = np.where(np.abs(single) < 3e38, kept.view(np.float32), single)
    return out.astype(np.float32)
