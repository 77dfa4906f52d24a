"""Checksums of arrays in result files: Fletcher's of 32 bits, as the filter of HDF5 has it.

Source: J. G. Fletcher, *IEEE Trans. Commun.* 30 (1982) 247-252; HDF5, ``H5checksum.c``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

#: Words that are summed at once; their weighted sum stays below 2^32.
WORDS = 256
MODULUS = 65535
#: Words that are summed without their remainders.
FEW = 1 << 13


def fletcher32(data: bytes) -> int:
    """Checksum of bytes, taken as big-endian words of two; an odd one is filled up with zero.

    Examples
    --------
    >>> hex(fletcher32(b"abcde"))
    '0x4ff029c7'
    """
    words = np.frombuffer(data + bytes(-len(data) % 2), ">u2")
    if len(words) <= FEW:
        low = int(words.sum(dtype=np.int64))
        high = int(words.astype(np.int64) @ np.arange(len(words), 0, -1))
        zero = MODULUS if low else 0
        return (high % MODULUS or zero) << 16 | (low % MODULUS or zero)
    rows = -(-len(words) // WORDS)
    table = np.zeros((rows, WORDS), np.uint32)
    table.ravel()[: len(words)] = words
    sums = table.sum(axis=1, dtype=np.uint32).astype(np.int64)
    places = np.einsum("ij,j->i", table, np.arange(WORDS, dtype=np.uint32)).astype(np.int64)
    # The second sum weighs a word by the number of words from it to the end.
    behind = len(words) - WORDS * np.arange(rows)
    second = ((sums % MODULUS) * (behind % MODULUS) - places) % MODULUS
    # Carries are added to the low end, which leaves zero only where all words are zero.
    zero = MODULUS if sums.any() else 0
    low, high = int(sums.sum()) % MODULUS, int(second.sum()) % MODULUS
    return (high or zero) << 16 | (low or zero)
