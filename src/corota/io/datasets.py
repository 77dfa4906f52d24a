"""Data sets of HDF5 files with checksums, by the low-level interface of h5py.

Property lists are shared, and no names are looked up in the file again: a data set takes half the
time of ``Group.create_dataset``, which is most of the time of writing the files of a small job.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@lru_cache(maxsize=256)
def _layout(chunks: tuple[int, ...] | None, level: int, fill: float | None) -> Any:
    """Properties of a data set: chunks with checksums, packed by gzip from level 1 on."""
    from h5py import h5p

    made = h5p.create(h5p.DATASET_CREATE)
    made.set_obj_track_times(False)
    if chunks is not None:
        made.set_chunk(chunks)
        if level:
            made.set_shuffle()
            made.set_deflate(level)
        made.set_fletcher32()
    if fill is not None:
        made.set_fill_value(np.array(fill))
    return made


@lru_cache(maxsize=64)
def _type(dtype: np.dtype[Any]) -> Any:
    from h5py import h5t

    return h5t.py_create(dtype, logical=True)


def make_group(parent: Any, name: str) -> Any:
    """Create a group."""
    from h5py import Group, h5g

    return Group(h5g.create(parent.id, name.encode(), gcpl=_of_groups()))


@lru_cache(maxsize=1)
def _of_groups() -> Any:
    from h5py import h5p

    made = h5p.create(h5p.GROUP_CREATE)
    made.set_obj_track_times(False)
    return made


def store(group: Any, name: str, values: ArrayLike, level: int = 0) -> None:
    """Write an array that does not change, with a checksum; `level` packs it."""
    from h5py import h5d, h5s

    data = np.asarray(values, order="C")
    # HDF5 has no empty chunks.
    layout = _layout(data.shape if data.size else None, level, None)
    space, kind = h5s.create_simple(data.shape), _type(data.dtype)
    made = h5d.create(group.id, name.encode(), kind, space, layout)
    made.write(h5s.ALL, h5s.ALL, data, kind)


class Series:
    """A data set that grows by rows at its end.

    Parameters
    ----------
    made : h5py.h5d.DatasetID
    level : int
        Of gzip, 0 for none.
    fill : float
        Of rows that are not written.
    """

    def __init__(
        self, made: Any, dtype: np.dtype[Any], chunks: tuple[int, ...], level: int, fill: float
    ) -> None:
        self._id, self.dtype, self.chunks = made, dtype, chunks
        self.level, self.fill = level, fill

    @property
    def rows(self) -> int:
        """Rows so far."""
        return int(self._id.shape[0])

    @classmethod
    def create(
        cls,
        group: Any,
        name: str,
        shape: tuple[int, ...],
        dtype: Any,
        chunks: tuple[int, ...],
        *,
        level: int = 0,
        fill: float | None = None,
        data: NDArray[Any] | None = None,
    ) -> Series:
        """Create it with some rows; those that are not written are `fill`, or 0."""
        from h5py import h5d, h5s

        number = np.dtype(dtype)
        kind = _type(number)
        space = h5s.create_simple(shape, (h5s.UNLIMITED, *shape[1:]))
        layout = _layout(chunks, level, fill)
        made = h5d.create(group.id, name.encode(), kind, space, layout)
        if data is not None and data.size:
            made.write(h5s.ALL, h5s.ALL, np.ascontiguousarray(data), kind)
        return cls(made, number, chunks, level, fill or 0.0)

    @classmethod
    def open(cls, group: Any, name: str) -> Series:
        """Continue one of an existing file."""
        found = group[name]
        level = found.compression_opts or 0
        return cls(found.id, found.dtype, found.chunks, level, float(found.fillvalue))

    def resize(self, rows: int) -> None:
        """Cut it off, or extend it by rows of its fill value."""
        self._id.set_extent((rows, *self._id.shape[1:]))

    def write(self, first: int, rows: NDArray[Any]) -> None:
        """Write rows from number `first` on; the data set has room for them."""
        from h5py import h5s

        if not rows.size:
            return
        data = np.ascontiguousarray(rows, self.dtype)
        space = self._id.get_space()
        space.select_hyperslab((first,) + (0,) * (data.ndim - 1), data.shape)
        self._id.write(h5s.create_simple(data.shape), space, data, _type(self.dtype))

    def write_chunk(self, place: tuple[int, ...], data: bytes) -> None:
        """Write a chunk that is packed already, and has its checksum."""
        self._id.write_direct_chunk(place, data)
