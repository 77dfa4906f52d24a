"""The report: one page for a browser, from results in memory, from files, or of a run in progress.

The page is one self-contained file: styles, scripts and data are inside, the data
deflated. ``assets`` contains the parts of the page; Python selects the data and assembles the page.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from corota.errors import FileError
from corota.report.content import LIMIT, compared, content_of_job, content_of_results
from corota.report.page import page

if TYPE_CHECKING:
    from os import PathLike

    from corota.results.results import Results


def write_report(
    results: Results, path: str | PathLike[str], *, limit: float = LIMIT, title: str = ""
) -> Path:
    """Write results as one page for a browser.

    Parameters
    ----------
    results : Results
        Of an analysis, or read from a file.
    path : path-like
        ``.html``.
    limit : float
        Size limit of the page [megabytes]; excess data are thinned, with a note in the page.
    title : str
        Heading; the name of the model by default.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the limit is too small for the model and two frames.
    FileError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> import corota as ct
    >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name="beam")
    >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    >>> model.fix("left")
    >>> model.force("right", y=0.01)
    >>> results = ct.solve(model, ct.Static(increments=2), threads=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = results.report(pathlib.Path(folder) / "beam.html")
    ...     "https://" in path.read_text().split("<script")[0]
    False
    """
    return _write(page(content_of_results(results, limit=limit, title=title)), path)


def report_job(
    job: str | PathLike[str],
    path: str | PathLike[str] | None = None,
    *,
    other: str | PathLike[str] | None = None,
    limit: float = LIMIT,
    title: str = "",
) -> Path:
    """Write the files of a job as one page; the run may have failed or be in progress.

    Parameters
    ----------
    job : path-like
        Stem of the files, or any file of the job: deck, result file, table.
    path : path-like, optional
        ``JOB.html`` beside the files by default.
    other : path-like, optional
        Another job, such as a variant: its curves are drawn dashed beside those of the job, and a
        table compares the largest values.
    limit, title
        As in :func:`write_report`.

    Returns
    -------
    Path

    Raises
    ------
    FileError
        If there are no files of such a job, or the page cannot be written.
    """
    from corota.report.records import find_job

    files = find_job(job)
    found = content_of_job(files, limit=limit, title=title)
    if other is not None:
        found = compared(found, find_job(other))
    return _write(page(found), path or files.path("html"))


def _write(text: str, path: str | PathLike[str]) -> Path:
    from corota.io.atomic_file import replace_text

    target = Path(path)
    if target.is_file() and target.suffix.lower() not in (".html", ".htm"):
        raise FileError(f"{target}: this file is no page and would be replaced; use a name .html")
    replace_text(target, text)
    return target


__all__ = ["LIMIT", "report_job", "write_report"]
