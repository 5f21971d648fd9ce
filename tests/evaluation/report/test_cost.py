"""`./reproduce cost` prices every job of a scale, and says what it cannot price."""

import logging
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from experiments.evaluation.report import cost
from experiments.evaluation.report.cost import main, overrides
from experiments.evaluation.report.rates import RATES
from experiments.plan import dry_run as dry_runs
from experiments.plan.dry_run import PlannedJob
from mobnet.core.errors import ConfigError
from mobnet.core.files import write_json

HOUR_S = 3600.0
Told = Callable[[], str]
JOBS = [  # that a made-up run would start
    PlannedJob("all", "all", {}, ("",), {}),
    PlannedJob("fit", "fit/plant/MOB-fric", {"robot": "plant", "method": "MOB-fric"}, ("a",), {}),
    PlannedJob("table", "table/table_05", {"table": "table_05"}, ("b",), {"disk_mb": "300"}),
    PlannedJob("table", "table/table_08", {"table": "table_08"}, ("c",), {}),
]


@pytest.fixture(autouse=True)
def rates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """A folder in which every job took 36 s and 500 MiB, the table 8 is not known, and a run starts the jobs above."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cost, "dry_run", lambda *_, **__: JOBS)
    kinds = {kind: {"cpu_s": {"job": 36.0}, "peak_mib": {"job": 500.0}} for kind in ("fit", "table_05")}
    note = {"processor": "made-up", "scale": "smoke", "core_h": 0.04, "peak_mib": 500.0, "kinds": kinds}
    write_json(RATES, note)
    return note


@pytest.fixture
def told(caplog: pytest.LogCaptureFixture) -> Told:
    """Return a function that returns what was told since its last call."""
    caplog.set_level(logging.INFO)

    def text() -> str:
        found = "\n".join(caplog.messages)
        caplog.clear()
        return found

    return text


def test_every_job_is_priced_and_the_rest_is_named(told: Told) -> None:
    assert main(["--config", "scale=smoke"]) == 0
    text = told()
    assert f"| all jobs | 2 | {2 * 36 / HOUR_S:.2f} | 500 |" in text
    assert "disk: 0.3 GB" in text
    assert "without a rate, and not counted: table_08" in text
    assert "(-50 %), 500 MiB where it took 500 (+0 %)" in text


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["scale"], "--config: 'scale' is not accepted; accepted: KEY=VALUE, a key of configs"),
        (["scale=huge"], "'huge' is not accepted; accepted: default, paper, quick, smoke"),
    ],
)
def test_what_is_not_accepted_is_one_line(words: list[str], line: str, told: Told) -> None:
    assert main(["--config", *words]) == 1
    text = told()
    assert line in text
    assert "\n" not in text


def test_without_rates_one_line_says_so(told: Told) -> None:
    RATES.unlink()
    assert main([]) == 1
    assert told().startswith(f"{RATES}: file is missing")


@pytest.mark.parametrize("value", ["[1", "[" * 4000, "{a: b: c}"])
def test_a_value_that_is_no_yaml_is_one_line(value: str) -> None:
    with pytest.raises(ConfigError, match=r"--config: .*; accepted: a value in plain YAML") as told:
        overrides([f"seed={value}"])
    assert len(str(told.value).splitlines()) == 1


def test_with_targets_only_what_is_out_of_date_is_priced(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[Any, ...]] = []

    def planned(targets: Sequence[str], config: Sequence[str], *, from_nothing: bool) -> list[PlannedJob]:
        asked.append((targets, config, from_nothing))
        return JOBS[:2]

    monkeypatch.setattr(cost, "dry_run", planned)
    assert main(["tables/smoke/table_05.tex", "--config", "scale=smoke"]) == 0
    assert f"| all jobs | 1 | {36 / HOUR_S:.2f} | 500 |" in told()
    assert main(["--config", "scale=smoke"]) == 0
    assert asked[0] == (["tables/smoke/table_05.tex"], ["scale=smoke"], False)
    assert asked[2] == (["all"], ["scale=smoke"], True)


@pytest.mark.parametrize(
    ("words", "runs"),
    [
        (["--config", "scale=smoke"], 1),
        (["--config", "scale=smoke", "seed=2"], 2),
        (["--config", "scale=quick"], 2),
        (["tables/smoke/table_05.tex"], 2),
    ],
)
def test_the_published_run_is_planned_once(
    words: list[str], runs: int, told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[object] = []

    def planned(*words: object, from_nothing: bool) -> list[PlannedJob]:
        asked.append(words)
        return JOBS

    monkeypatch.setattr(cost, "dry_run", planned)
    assert main(words) == 0
    assert len(asked) == runs
    assert "(-50 %), 500 MiB where it took 500 (+0 %)" in told()


def test_of_a_target_that_is_up_to_date_nothing_is_priced(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cost, "dry_run", lambda *_, from_nothing: JOBS if from_nothing else [])
    assert main(["tables/smoke/table_05.tex", "--config", "scale=smoke"]) == 0
    assert "nothing would run" in told()
    assert "| stage |" not in told()


def test_a_target_that_nobody_makes_is_one_line(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    done = subprocess.CompletedProcess((), 1, "", "tables/table_99.tex: is no target; did you mean all?\n\n")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: done)
    monkeypatch.setattr(cost, "dry_run", dry_runs.dry_run)
    assert main(["tables/table_99.tex"]) == 1
    assert told() == "tables/table_99.tex: is no target; did you mean all?"


def test_rates_of_jobs_that_are_gone_are_told(told: Told, rates: dict[str, object]) -> None:
    kinds = dict(rates["kinds"]) | {"observe": {"cpu_s": {"job": 1.0}, "peak_mib": {"job": 1.0}}}  # type: ignore[call-overload]
    write_json(RATES, {**rates, "kinds": kinds})
    assert main(["--config", "scale=smoke"]) == 0
    assert told().endswith("its jobs were cut in another way, so that prices are rough: observe")


def test_a_target_is_priced_at_the_scale_that_its_path_names(told: Told) -> None:
    assert main(["tables/smoke/table_05.tex"]) == 0
    assert told().startswith("scale smoke, ")
    assert main(["tables/smoke/table_05.tex", "--config", "scale=default"]) == 1
    assert told() == "tables/smoke/table_05.tex: is not made at scale=default; accepted: --config scale=smoke"
