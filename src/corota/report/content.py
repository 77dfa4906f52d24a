"""Contents of a page: chunks of the model, the history of the run, and as many frames as fit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import FileError, InputError
from corota.io.modes import as_results
from corota.io.regular_file import parse_json, read_bytes
from corota.io.result_reader import FileResults, read_vtkhdf
from corota.mesh.kinds import KINDS
from corota.model import elements
from corota.model.contact import edges_or_nodes
from corota.model.description import describe, rigid_curves
from corota.model.summary import model_lines
from corota.model.units import Units
from corota.report.chunk import pack
from corota.report.fields import NodalArrays
from corota.report.records import ITERATION, JobPaths, Records, records_of_files, records_of_results
from corota.results import variables as vf
from corota.results.averaging import AVERAGING
from corota.results.derived import DERIVED
from corota.results.table import MEANING, NODAL, POSITIVE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.arrays import Ints
    from corota.results.results import Frame, Results


#: Size of a page [megabytes], of 10^6 bytes.
LIMIT = 9.5
#: Bytes of base64 per byte of data, and size of the page itself [bytes].
BASE64, OWN = 4.0 / 3.0, 250_000
#: Frames at most; more make a page slow to open.
MOST_FRAMES = 240
#: Number of frames below which less important arrays are omitted instead.
FEW_FRAMES = 40
#: Bits behind the point, of pages that hold many frames and of those of huge models.
BITS, FEWER_BITS = 14, 10
#: Dimensions of the quantities in the tables of the model.
DIMENSIONS = (
    *("length", "time", "force", "force*length", "force/length^2", "force/length^3"),
    *("mass", "mass/length^3", "length/time^2"),
)
#: Largest number of rows of the history, and of iterations.
MOST_ROWS, MOST_ITERATIONS = 5000, 20000


@dataclass
class Content:
    """Chunks of a page by their names, in the order in which they are opened.

    Parameters
    ----------
    chunks : dict of str to bytes
        ``model``, ``history``, ``frame-0``, ...
    notes : list of str
        What was thinned or omitted.
    """

    title: str
    chunks: dict[str, bytes] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    @property
    def size(self) -> int:
        """Bytes of all chunks."""
        return sum(len(data) for data in self.chunks.values())


def content_of_results(results: Results, *, limit: float = LIMIT, title: str = "") -> Content:
    """Content of a page about results in memory, or of a file without those beside it."""
    if isinstance(results, FileResults):
        from pathlib import Path

        from corota.report.records import find_job

        records = records_of_files(find_job(Path(results.path)))
        if not records.rows:
            _rows_of_frames(records, results)
        return _content(results, records, limit, title)
    return _content(results, records_of_results(results), limit, title)


def compared(content: Content, other: JobPaths) -> Content:
    """The content of a page with the curves of another job beside its own."""
    records = records_of_files(other)
    facts: dict[str, Any] = {"job": other.name}
    if other.results is not None:
        with read_vtkhdf(other.results) as results:
            facts = facts_of(results, other.name)
            if not records.rows:
                _rows_of_frames(records, results)
    notes: list[str] = []
    content.chunks["other"] = history_chunk(records, facts, notes)
    content.notes += [f"{other.name}: {note}" for note in notes]
    return content


def content_of_job(job: JobPaths, *, limit: float = LIMIT, title: str = "") -> Content:
    """Content of a page about the files of a job, converged or not.

    Parameters
    ----------
    limit : float
        Size of the page [megabytes].
    title : str
        Name of the job by default.
    """
    records = records_of_files(job)
    provenance = _provenance(job)
    if job.results is None:
        return _content(None, records, limit, title or job.name, provenance=provenance)
    with read_vtkhdf(job.results) as results:
        if _other_run(records.start.get("run"), results):
            records = Records()
            records.notes.append(
                f"{job.name}.jsonl and {job.name}.csv are of another run than the results: left out"
            )
        if not records.rows:
            _rows_of_frames(records, results)
        more: list[tuple[str, FileResults]] = []
        try:
            for kind, ending in (("mode", "modes"), ("iterate", "last_iterate")):
                beside = job.path(f"{ending}.vtkhdf")
                if not beside.is_file():
                    continue
                other = read_vtkhdf(beside)
                if _other_run(other.attributes.get("run"), results):
                    other.close()
                    records.notes.append(f"{beside.name} is of another run: left out")
                else:
                    more.append((kind, other))
            return _content(results, records, limit, title, more, provenance)
        finally:
            for _, other in more:
                other.close()


def _other_run(name: object, results: FileResults) -> bool:
    """Whether a file that bears the name of its run is not of the run of the results."""
    run = results.attributes.get("run")
    return bool(name and run) and name != run


def _provenance(job: JobPaths) -> dict[str, Any]:
    path = job.path("provenance.json")
    try:
        found: dict[str, Any] = parse_json(read_bytes(path))
    except (FileError, ValueError):
        return {}
    return found


def _rows_of_frames(records: Records, results: FileResults) -> None:
    """Rows of the scalars in the result file, where there is neither table nor log."""
    records.names = ["step", "increment", "time", "step time", "load factor"]
    scalars = results.scalar_names()
    records.names += [name for name in scalars if name not in records.names]
    columns = [np.asarray(results.history(name)) for name in records.names]
    records.rows = np.stack(columns, axis=1).tolist() if len(results.frames) else []


def _content(
    results: Results | None,
    records: Records,
    limit: float,
    title: str,
    more: Sequence[tuple[str, Results]] = (),
    provenance: dict[str, Any] | None = None,
) -> Content:
    name = title or (results.model.name if results is not None else "")
    content = Content(name)
    if results is not None:
        content.chunks["model"] = model_chunk(results)
        if not isinstance(results, FileResults):
            more = [*more, *_more_of_memory(results)]
    facts = facts_of(results, name, provenance)
    content.chunks["history"] = history_chunk(records, facts, content.notes)
    budget = int((limit * 1e6 - OWN) / BASE64) - content.size
    frames: list[tuple[str, NodalArrays, list[int]]] = []
    if results is not None:
        for kind, of in [("increment", results), *more]:
            wanted = list(range(len(of.frames)))[1 if kind == "iterate" else 0 :]
            frames.append((kind, NodalArrays(of), wanted))
    chunks = _frames(frames, budget, content.notes, name)
    if content.notes:  # again, with the notes on omitted data
        content.chunks["history"] = history_chunk(records, facts, content.notes, again=True)
    for number, data in enumerate(chunks):
        content.chunks[f"frame-{number}"] = data
    return content


def _more_of_memory(results: Results) -> list[tuple[str, Results]]:
    from corota.results.results import Results as Plain

    found: list[tuple[str, Results]] = []
    if results.modes:
        found.append(("mode", as_results(results)))
    if results.last_state is not None and results.last_iterate is not None:
        found.append(("iterate", Plain(results.model, [results.last_state, results.last_iterate])))
    return found


def facts_of(
    results: Results | None, name: str, provenance: dict[str, Any] | None = None
) -> dict[str, Any]:
    """Name, versions, counts and phase times."""
    facts: dict[str, Any] = {"job": name, "provenance": provenance or {}}
    if results is not None:
        facts["info"] = results.info
        facts["units"] = str(results.model.unit_system)
        facts["critical points"] = [
            {"kind": p.kind, "step": p.step, "increment": p.increment, "text": str(p)}
            for p in results.critical_points
        ]
        if isinstance(results, FileResults):
            facts["file"] = results.attributes
    return facts


# The model.
def model_chunk(results: Results, level: int = 9) -> bytes:
    """Mesh, sets, sections, supports, loads, contact surfaces: the constant data."""
    model, mesh = results.model, results.mesh
    arrays: dict[str, NDArray[Any]] = {
        "points": mesh.points.astype(np.float32),
        "node labels": mesh.node_labels,
        "section of cells": results.sections(),
    }
    blocks = []
    for number, cells in enumerate(mesh.cells):
        of = KINDS[cells.kind]
        blocks.append({"kind": of.name, "edges": of.edges})
        if of.edges:
            blocks[-1] |= {"powers": of.powers, "coefficients": of.coefficients.tolist()}
        arrays[f"nodes {number}"] = cells.nodes
        arrays[f"labels {number}"] = cells.labels
    sets: dict[str, list[str]] = {"node": [], "cell": [], "edge": []}
    for kind in ("node", "cell"):
        for name, members in getattr(mesh, f"{kind}_sets").items():
            arrays[f"{kind} set {len(sets[kind])}"] = np.asarray(members)
            sets[kind].append(name)
    for name, pairs in mesh.edge_sets.items():
        arrays[f"edge set {len(sets['edge'])}"] = _ends(results, pairs)
        sets["edge"].append(name)
    surfaces: list[dict[str, Any]] = []
    for pair in model.contacts:
        for side in ("slave", "master"):
            where = getattr(pair, side)
            if isinstance(where, str | np.ndarray):
                # A surface of single nodes has no edges to draw.
                edges, _ = edges_or_nodes(mesh, where)
                arrays[f"{side} {len(surfaces)}"] = _ends(results, edges)
        surfaces.append({"name": pair.name})
    described = getattr(results, "description", None)
    if described is None:
        described = describe(model, results.steps)
    units = model.unit_system
    derived = {name: item.meaning for name, item in DERIVED.items()}
    header = {
        "name": model.name,
        "lines": model_lines(model),
        "blocks": blocks,
        "sets": sets,
        "pairs": surfaces,
        "rigid": rigid_curves(model),
        "description": described,
        "meaning": {n: _meaning(n, units) for n in (*MEANING, *derived)},
        "positive": sorted(POSITIVE),
        "units": {of: units.label(of) for of in DIMENSIONS},
        "averaging": AVERAGING,
        "line elements": list(elements.line_names()),
    }
    return pack(header, arrays, level)


def _meaning(name: str, units: Units) -> str:
    """Description of a field of the page, which shows nodal values."""
    return vf.described(name, units) + ", nodal" * (name not in NODAL)


def _ends(results: Results, pairs: Any) -> Ints:
    """Nodes of edges: first, last, and the middle or -1; shape (n, 3)."""
    nodes = [n if len(n) == 3 else [*n, -1] for n in results.mesh.edge_nodes(pairs)]
    return np.array(nodes, dtype=np.int64).reshape(-1, 3)


# The history of the run.
def history_chunk(
    records: Records,
    facts: dict[str, Any],
    notes: list[str],
    again: bool = False,
    level: int = 9,
) -> bytes:
    """Rows, iterations, cut-backs, notes and the end of the run.

    Parameters
    ----------
    facts : dict
        Name, versions and counts, for the tables.
    notes : list of str
        Notes on omitted data; those on data thinned here are added.
    again : bool
        Whether the notes have them already.
    level : int
        Of zlib.
    """
    table = records.table()
    kept = thinned(len(table), MOST_ROWS)
    if len(kept) < len(table) and not again:
        notes.append(f"The curves show {len(kept):,} of {len(table):,} increments.")
    iterations = np.array(records.iterations, dtype=np.float64).reshape(-1, len(ITERATION))
    chosen = thinned(len(iterations), MOST_ITERATIONS)
    if len(chosen) < len(iterations) and not again:
        notes.append(f"The residuals are of {len(chosen):,} of {len(iterations):,} iterations.")
    header = {
        "facts": facts,
        "names": records.names,
        "units": {**units_of(records.names, str(facts.get("units", ""))), **records.units},
        "iteration names": ITERATION,
        "cut backs": records.cut_backs,
        "steps": records.steps,
        "notes": records.notes,
        "left out": notes,
        "start": records.start,
        "end": records.end,
    }
    arrays = {
        "rows": table[kept],
        "iterations": iterations[chosen],
        "iteration numbers": chosen,
    }
    return pack(header, arrays, level)


def units_of(names: Sequence[str], system: str) -> dict[str, str]:
    """Units of columns and axis labels, of those that have one.

    Parameters
    ----------
    system : str
        The units of the model, such as ``mm, N, t, s``.
    """
    units = Units.of(*filter(None, system.split(", ")))
    of = {name: vf.dimension(name) for name in names}
    of |= {name: "force" for name in names if re.search(r": (force|friction) [xy]$", name)}
    of |= {"energy": "energy", "force": "force", "time": "time", "time increment": "time"}
    found = {name: units.label(dimension) for name, dimension in of.items()}
    return {name: unit for name, unit in found.items() if unit and unit != "rad"}


def thinned(count: int, most: int) -> Ints:
    """Indices of `most` of `count` rows, evenly, the first and the last among them."""
    if count <= most:
        return np.arange(count)
    return np.unique(np.linspace(0, count - 1, most).round().astype(np.int64))


# The frames.
def frame_chunk(
    kind: str, arrays: NodalArrays, index: int, names: list[str], bits: int, level: int = 9
) -> bytes:
    """Arrays of a frame with its step, increment, time and other labels."""
    frame = arrays.results.frames
    head = _head(kind, frame, index)
    return pack(head, arrays.read(index, names, bits), level)


def _head(kind: str, frames: Sequence[Frame], index: int) -> dict[str, Any]:
    scalars = getattr(frames, "head", None)
    if scalars is not None:
        found: dict[str, float] = scalars(index)
    else:
        frame = frames[index]
        found = {
            **frame.scalars,
            "step": frame.step,
            "increment": frame.increment,
            "time": frame.time,
            "load factor": frame.factor,
        }
    head: dict[str, Any] = {
        n: found.get(n, 0.0) for n in ("step", "increment", "time", "load factor")
    }
    head["kind"], head["index"] = kind, index
    if kind == "mode":
        named = next((n for n in ("frequency", "buckling factor") if n in found), "")
        head["label"] = f"mode {index + 1}" + (f", {named} {found[named]:.6g}" if named else "")
    elif kind == "iterate":
        head["label"] = "last attempt, not in equilibrium"
    return head


def _frames(
    sets: Sequence[tuple[str, NodalArrays, list[int]]], budget: int, notes: list[str], name: str
) -> list[bytes]:
    """Chunks of as many frames as fit the budget [bytes]."""
    total = sum(len(wanted) for _, _, wanted in sets)
    if not total:
        return []
    kind, arrays, wanted = sets[0]
    others = [(k, a, i) for k, a, w in sets[1:] for i in w]
    rest = [frame_chunk(k, a, i, ["U"], BITS) for k, a, i in others]
    budget -= sum(map(len, rest))
    names, bits, count = _plan(arrays, wanted, budget)
    while True:
        chosen = [wanted[i] for i in _pick(arrays, wanted, count)]
        chunks = [frame_chunk(kind, arrays, i, names, bits) for i in chosen]
        size = sum(map(len, chunks))
        if size <= budget:
            break
        if count <= 2:
            raise InputError(
                f"a page of {name} needs {(size - budget) * BASE64 / 1e6:.1f} megabytes more than "
                "the limit; raise it"
            )
        count = max(2, min(count - 1, int(0.95 * count * budget / size)))
    if len(chosen) < len(wanted):
        notes.append(
            f"The player shows {len(chosen)} of {len(wanted):,} frames; curves and tables have all "
            "increments."
        )
    if len(names) < len(arrays.names):
        gone = [n for n in arrays.names if n not in names]
        notes.append(f"Omitted to limit the size of the page: {', '.join(gone)}.")
    if bits < BITS:
        notes.append("Values at nodes are rounded to three digits to limit the size of the page.")
    return [*chunks, *rest]


def _plan(arrays: NodalArrays, wanted: list[int], budget: int) -> tuple[list[str], int, int]:
    """Names, bits and number of frames that probably fit the budget."""
    few = min(len(wanted), FEW_FRAMES)
    sample = [wanted[len(wanted) // 2], wanted[-1]]
    for bits in (BITS, FEWER_BITS):
        sizes = {}
        for name in arrays.names:
            packed = [len(pack({}, arrays.read(i, [name], bits))) for i in sample]
            sizes[name] = max(packed)
        names = list(arrays.names)
        while len(names) > 2 and few * sum(sizes[n] for n in names) > budget:
            names.pop()
        size = sum(sizes[n] for n in names) + 200
        if size * min(few, 4) <= budget:
            break
    return names, bits, max(min(len(wanted), MOST_FRAMES, int(budget // size)), min(len(wanted), 2))


def _pick(arrays: NodalArrays, wanted: list[int], count: int) -> list[int]:
    """Places of frames: first and last, the ends of steps where they fit, the rest evenly."""
    n = len(wanted)
    if n <= count:
        return list(range(n))
    heads = [_head("increment", arrays.results.frames, i)["step"] for i in wanted]
    ends = [i for i in range(n - 1) if heads[i] != heads[i + 1]]
    if len(ends) > count // 3:
        ends = []
    places = set(thinned(n, max(count - len(ends), 2)).tolist()) | set(ends)
    return sorted(places)
