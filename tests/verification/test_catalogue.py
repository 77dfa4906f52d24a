"""The quick problems of the catalog, and what the catalog promises of every problem."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest

from corota.cli import main
from corota.verification import catalogue, runner
from corota.verification.catalogue import Value, problems

#: Seconds: longer ones run with `corota verify` only, but for what nothing else tests.
QUICK = 0.5
ALWAYS = {"annulus_pressure", "cook_linear", "manufactured_solutions", "short_cantilever"}


@pytest.mark.parametrize(
    "name", [n for n, p in problems().items() if p.seconds <= QUICK or n in ALWAYS]
)
def test_problem_is_within_its_tolerances(name: str) -> None:
    outcome = runner.measure(name)
    assert not outcome.error, outcome.error
    assert outcome.values
    for value in outcome.values:
        assert value.ok, value


def test_every_problem_says_what_it_is() -> None:
    assert len(problems()) >= 10
    for name, problem in problems().items():
        assert problem.group in catalogue.GROUPS, name
        assert len(problem.description.splitlines()) >= 3, name
        assert problem.source, name
        assert problem.why, name


def test_no_number_is_no_success() -> None:
    for kind in ("relative", "absolute", "at least", "at most"):
        for found in (float("nan"), float("inf"), float("-inf")):
            assert not Value("x", 1.0, found, 1.0, kind).ok  # type: ignore[arg-type]
    assert Value("x", 1.8, 2.0, 0.0, "at least").ok
    assert not Value("x", 1.8, 1.7, 0.0, "at least").ok
    assert not Value("x", 1.0, 1.1, 0.05).ok


def test_the_command_measures_and_counts(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "straight_*", "--jobs", "1"]) == 0
    said = capsys.readouterr().out
    assert "1 of 1 problems and 36 of 36 values" in said
    assert main(["verify", "straight_beam", "--json"]) == 0
    records = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [r["event"] for r in records] == ["value"] * 36 + ["end"]
    assert all(r["ok"] for r in records[:-1])


def test_a_miss_ends_with_its_code(capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    def wrong(chosen, done, **options):
        return [runner.Outcome(p.name, [Value("x", 1.0, 2.0, 0.1)], 0.1) for p in chosen]

    monkeypatch.setattr("corota.cli.verify.run_problems", wrong)
    assert main(["verify", "straight_beam"]) == 4
    said = capsys.readouterr()
    assert "MISSED" in said.out
    assert "straight_beam: x: 2, not 1" in said.err


def test_a_problem_that_fails_is_a_miss(monkeypatch) -> None:
    def broken():
        raise ZeroDivisionError("by zero")

    problem = problems()["straight_beam"]
    monkeypatch.setattr(problem, "measure", broken)
    outcome = runner.measure("straight_beam")
    assert not outcome.ok
    assert "by zero" in outcome.error


def test_names_are_listed_and_unknown_ones_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--list"]) == 0
    assert "cook_linear" in capsys.readouterr().out
    assert main(["verify", "nothing_like_it"]) == 2
    assert "--list" in capsys.readouterr().err


@pytest.mark.usefixtures("quick_pictures")
def test_pages_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    assert main(["verify", "curved_beam", "--full", "--pages", str(tmp_path), "--jobs", "1"]) == 0
    page = (tmp_path / "curved_beam.md").read_text(encoding="utf-8")
    assert "0.0886" in page
    assert "Goodier" in page
    assert "| OPT |" in page
    for name in ("curved_beam.png", "curved_beam-convergence.png"):
        assert f"figures/{name}" in page
        assert 2_000 < (tmp_path / "figures" / name).stat().st_size < 60_000
    assert "curved_beam.md" in (tmp_path / "index.md").read_text(encoding="utf-8")


def test_a_process_that_ends_takes_only_its_own_problem_with_it(monkeypatch) -> None:
    reported: list[str] = []
    chosen = [problems()[n] for n in ("straight_beam", "curved_beam")]

    class Pool:
        def __init__(self, *_: object, **__: object) -> None:
            self.broken = False

        def __enter__(self) -> Pool:
            return self

        def __exit__(self, *_: object) -> None:
            pass

        def submit(self, work, name, *rest):
            future = Future()
            self.broken |= name == "curved_beam"
            if self.broken or (name == "straight_beam" and not reported and len(submitted) == 0):
                future.set_exception(BrokenProcessPool())
            else:
                future.set_result(runner.Outcome(name, [Value("x", 1.0, 1.0, 0.1)]))
            submitted.append(name)
            return future

    submitted: list[str] = []
    monkeypatch.setattr(runner, "ProcessPoolExecutor", Pool)
    outcomes = runner.run(chosen, lambda outcome: reported.append(outcome.name))
    assert [o.ok for o in outcomes] == [True, False]
    assert "ended" in outcomes[1].error
    assert sorted(reported) == ["curved_beam", "straight_beam"]
