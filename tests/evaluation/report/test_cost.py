"""`./reproduce cost` prices every job of a scale, and says what it cannot price."""

import logging
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from experiments.evaluation.report.compute import WHOLE
from experiments.evaluation.report.cost import costs, main, overrides
from experiments.evaluation.report.rates import RATES, RatesNote
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError
from mobnet.core.files import write_json
from mobnet.core.notes import read_note

HOUR_S = 3600.0
REPO = Path(__file__).parents[3]
Told = Callable[[], str]


@pytest.fixture(autouse=True)
def rates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, object]:
    """A folder in which every job of the smoke scale took 36 s and 500 MiB, and the table 8 is not known."""
    monkeypatch.chdir(tmp_path)
    works = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False).work
    kinds = {work.kind: {"cpu_s": {"job": 36.0}, "peak_mib": {"job": 500.0}} for work in works}
    del kinds["table_08"]
    note = {"processor": "made-up", "scale": "smoke", "core_h": len(works) / 50, "peak_mib": 500.0, "kinds": kinds}
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
    jobs = len(make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False).work) - 1
    assert f"| all jobs | {jobs} | {jobs * 36 / HOUR_S:.2f} | 500 |" in text
    assert "without a rate, and not counted: table_08" in text
    assert "(-50 %), 500 MiB where it took 500 (+0 %)" in text


def test_each_larger_scale_costs_more(told: Told) -> None:
    found: list[float] = []
    for scale in ("smoke", "quick", "default", "paper"):
        assert main(["-C", f"scale={scale}"]) == 0
        found.append(float(told().split("| all jobs |")[1].split("|")[1]))
    assert found == sorted(set(found))


def test_quick_fits_into_its_hour_by_the_published_rates() -> None:
    """75 minutes on two cores, some of which a run does not use; detection has no rate yet."""
    plan = make_plan(load_settings(overrides={"scale": "quick"}), with_pdf=False)
    jobs, cpu_s, _ = costs(plan.work, read_note(REPO / RATES, RatesNote).kinds)[WHOLE]
    assert jobs > len(plan.work) - len(plan.products)
    assert cpu_s < 2.3 * HOUR_S


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
    asked: list[tuple[str, ...]] = []

    def dry_run(words: Sequence[str], **_: object) -> subprocess.CompletedProcess[str]:
        asked.append(tuple(words))
        return subprocess.CompletedProcess(
            words, 0, "    rule collect_forward_walk_ideal_s101:\n    rule table_05:\n", ""
        )

    monkeypatch.setattr(subprocess, "run", dry_run)
    assert main(["tables/smoke/table_05.tex", "--config", "scale=smoke"]) == 0
    assert f"| all jobs | 2 | {72 / HOUR_S:.2f} | 500 |" in told()
    assert asked[-1][-4:] == ("--config", "scale=smoke", "--", "tables/smoke/table_05.tex")


def test_of_a_target_that_is_up_to_date_nothing_is_priced(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    done = subprocess.CompletedProcess(
        (), 0, "Nothing to be done (all requested files are present and up to date).", ""
    )
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: done)
    assert main(["tables/smoke/table_05.tex", "--config", "scale=smoke"]) == 0
    assert "nothing would run" in told()
    assert "| stage |" not in told()


def test_a_target_that_nobody_makes_is_one_line(told: Told, monkeypatch: pytest.MonkeyPatch) -> None:
    def dry_run(words: Sequence[str], **_: object) -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess(
            words, 1, "", "MissingRuleException:\nNo rule to produce tables/table_99.tex\n\n"
        )

    monkeypatch.setattr(subprocess, "run", dry_run)
    assert main(["tables/table_99.tex"]) == 1
    assert told() == "No rule to produce tables/table_99.tex"


def test_rates_of_jobs_that_are_gone_are_told(told: Told, rates: dict[str, object]) -> None:
    kinds = dict(rates["kinds"]) | {"observe": {"cpu_s": {"job": 1.0}, "peak_mib": {"job": 1.0}}}  # type: ignore[call-overload]
    write_json(RATES, {**rates, "kinds": kinds})
    assert main(["--config", "scale=smoke"]) == 0
    assert told().endswith("its jobs were cut in another way, so that prices are rough: observe")
