"""The runner of the benchmarks: every one is run, a missed bar is marked."""

import importlib
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
OTHERS = {"__main__", "jobs"}


@pytest.fixture
def runner(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))
    return importlib.import_module("benchmarks.__main__")


def test_every_benchmark_has_a_name(runner):
    assert {*runner.NAMES, *runner.LONG} == {path.stem for path in (ROOT / "benchmarks").glob("*.py")} - OTHERS


@pytest.mark.parametrize("name", sorted({path.stem for path in (ROOT / "benchmarks").glob("*.py")} - OTHERS))
def test_a_benchmark_finds_what_it_imports(runner, name):
    assert callable(importlib.import_module(f"benchmarks.{name}").main)


def test_the_table_marks_a_missed_bar(runner):
    row = {"name": "walk", "ours": 2.0, "reference": 1.0, "unit": "us", "ratio": 0.5}
    assert "missed" in runner.table([{**row, "bar": 0.65}])
    assert "missed" not in runner.table([{**row, "bar": 0.5}, row])


@pytest.mark.parametrize(("ours", "missed"), [
    (2.0, False), (2.1, True), (0.9, True), (1.0, False), (float("nan"), True),
])  # fmt: skip
def test_a_quantity_outside_its_bounds_or_not_measured_misses(runner, ours, missed):
    row = {"name": "falls", "ours": ours, "unit": "", "at_least": 1.0, "at_most": 2.0}
    assert runner.misses(row) == missed
    assert ("missed" in runner.table([row])) == missed
    assert not runner.misses({"name": "falls", "ours": ours, "unit": ""})


def test_an_unknown_benchmark_is_named_with_those_accepted(runner, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench", "collet_speed"])
    with pytest.raises(SystemExit, match="2"):
        runner.main()
    message = capsys.readouterr().err
    assert "'collet_speed'" in message
    assert "collect_speed, observer_speed" in message
