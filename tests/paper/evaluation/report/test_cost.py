"""`./reproduce cost` prices every job of a scale, and says what it cannot price."""

import logging
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from experiments.evaluation.report import cost
from experiments.evaluation.report.cost import main, overrides
from experiments.plan import dry_run as dry_runs
from experiments.plan.dry_run import PlannedJob
from experiments.plan.gpu import GPU_RATES
from experiments.plan.prices import RATES
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


LEG = {"robot": "plant", "method": "MOB-Net", "limb": "LL", "seed": "0"}
SPECTRAL = {"robot": "robot_1", "method": "GRU-spectral", "limb": "LL", "seed": "101"}
ALONE = [  # two networks that learn
    PlannedJob("train", "train/plant/MOB-Net-LL-s0", LEG, ("leg",), {}),
    PlannedJob("train", "train/robot_1/GRU-spectral-LL-s101", SPECTRAL, ("spectral",), {}),
]
STACK = {"stack": "plant-MOB-Net-LL-s0"}
SIDE_BY_SIDE = [
    PlannedJob("train_stack", "train_stack/plant-MOB-Net-LL-s0", STACK, ("stack",), {}),
    PlannedJob("train", "train/plant/MOB-Net-LL-s0", LEG, ("leg",), {}, ("stack",)),
    ALONE[1],
]


@pytest.fixture
def trained(rates: dict[str, object], monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Trainings, of which a core does 36 s of work, and a GPU an update of any networks in 3.2 s.

    Returns:
        Words of the configuration of each dry run.
    """
    asked: list[list[str]] = []

    def planned(_: Sequence[str], config: Sequence[str], *, from_nothing: bool) -> list[PlannedJob]:
        asked.append(list(config))
        return SIDE_BY_SIDE if any("side_by_side" in word for word in config) else ALONE

    monkeypatch.setattr(cost, "dry_run", planned)
    kind = {"cpu_s": {"job": 36.0, "GRU step": 3.6}, "peak_mib": {"job": 500.0}}
    write_json(RATES, {**rates, "kinds": {"train": kind}})
    shape = {"batch": 64, "horizon": 50, "units": 150, "alone": 1000.0}
    speeds = {"1": 1000.0, "2": 2000.0, "4": 4000.0}
    made = {"device": "NVIDIA X", "date": "2026", "torch": "2", "made_by": "a prototype"}
    write_json(GPU_RATES, {**made, **shape, "side_by_side": speeds, "trained": {}})
    return asked


def test_a_run_is_priced_without_a_gpu_and_with_one(told: Told, trained: list[list[str]]) -> None:
    """Smoke: stacks learn from 16 000 steps each, 4 sequences of 50 in an update, one network alone from 2000."""
    assert main(["--config", "scale=smoke"]) == 0
    alone, beside = told().split("with a GPU, on which networks of one shape learn side by side:\n")
    assert trained[:2] == [["scale=smoke"], ["scale=smoke", 'stacks={"side_by_side": true}']]
    steps = 16_000
    gpu_s, alone_s = 3.2 * steps / (4 * 50), 2000 / 1000
    assert f"| train | 2 | {(36 * 2 + 3.6 * steps) / HOUR_S:.2f} |" in alone
    assert f"time: {(36 + 3.6 * steps) / HOUR_S:.2f} h on 2 cores" in alone
    assert "GPU" not in alone
    assert f"| train | 3 | {36 * 3 / HOUR_S:.2f} |" in beside
    (side, after) = [line.split(" | ") for line in beside.splitlines() if line.startswith(("| networks", "| one net"))]
    assert side[1] == after[1] == "1"
    assert float(side[3].rstrip(" |")) == pytest.approx(gpu_s / HOUR_S, abs=0.005)
    assert float(after[3].rstrip(" |")) == pytest.approx(alone_s / HOUR_S, abs=0.005)
    assert "GPU-hours: rates of a prototype on an NVIDIA X (2026, torch 2), not of this code" in beside
    assert f"time: {(36 * 2 + gpu_s) / HOUR_S:.2f} h on 16 cores and one GPU" in beside


def test_what_the_configuration_says_of_stacks_stays(told: Told, trained: list[list[str]]) -> None:
    """A run on this machine that has stacks is priced once."""
    words = ["scale=smoke", "stacks={side_by_side: true, most: 3}"]
    assert main(["--config", *words]) == 0
    assert trained[:1] == [words]
    assert "with a GPU" in told()
    assert cost.with_stacks({"stacks": {"most": 3}})[0]["stacks"] == {"side_by_side": True, "most": 3}
    assert cost.with_stacks({"stacks": {"side_by_side": False}})[1] == 'stacks={"side_by_side": false}'
