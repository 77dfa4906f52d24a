"""Bytes as the filters *shuffle* and *gzip* of HDF5 read them, compressed only where it helps.

Shuffled numbers are planes: all first bytes, all second bytes, and so on. The planes of sign,
exponent and leading digits pack well. Those of the last digits do not, and trying takes most of the
time: a sample decides, and they are stored uncompressed. Sources: RFC 1950 and RFC 1951.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import zlib
from collections.abc import Sequence

#: Bytes of a sample, and the share of its size that packing must save.
SAMPLE, GAIN = 1 << 14, 0.4
#: Bytes of an array whose planes are packed together: there the number of blocks takes the time.
SMALL = 1 << 12
#: Bytes of a block without compression, at most; one without any.
LONGEST, _EMPTY = 50_000, b"\0\0\0\xff\xff"
#: Header of a zlib stream with a window of 32 KiB; the end of its last block.
_HEAD, _END = b"\x78\x01", b"\x03\x00"


def packed(planes: Sequence[bytes], level: int) -> bytes:
    """One zlib stream of all planes.

    Parameters
    ----------
    planes : sequence of bytes
        What follows each other in the unpacked data.
    level : int
        Level of deflate, 1 to 9. Level 1 searches runs only: digits of floating-point numbers have
        nothing else, and it takes half the time.
    """
    pieces, check = [_HEAD], 1
    if sum(map(len, planes)) <= SMALL:
        planes = [b"".join(planes)]
    for plane in planes:
        middle = max(0, (len(plane) - SAMPLE) // 2)
        sample = plane[middle : middle + SAMPLE]
        found = _deflated(sample, level)
        if len(found) >= (1.0 - GAIN) * len(sample):
            found = _stored(plane)
        elif len(sample) < len(plane):
            found = _deflated(plane, level)
        pieces.append(found)
        check = zlib.adler32(plane, check)
    return b"".join([*pieces, _END, check.to_bytes(4, "big")])


def _stored(data: bytes) -> bytes:
    """Blocks without compression, the last one empty, as zlib writes them at level 0."""
    if len(data) > LONGEST:
        return _deflated(data, 0)
    length = len(data).to_bytes(2, "little")
    return b"\0" + length + bytes(byte ^ 255 for byte in length) + data + _EMPTY


def _deflated(data: bytes, level: int) -> bytes:
    """Blocks of deflate up to a whole byte, none of them the last."""
    how = zlib.Z_RLE if level == 1 else zlib.Z_DEFAULT_STRATEGY
    window, memory = zlib.MAX_WBITS, zlib.DEF_MEM_LEVEL
    if level == 1:
        # Runs are the same with as little memory as the data need, which is there sooner.
        window = min(max(9, (len(data) + 300).bit_length()), window)
        memory = min(window - 6, memory)
    packer = zlib.compressobj(level, zlib.DEFLATED, -window, memory, how)
    return packer.compress(data) + packer.flush(zlib.Z_FULL_FLUSH)
