"""The table of trials: errors on walks of development, the best variant of each method marked."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden_table, read_table

from experiments.evaluation.tables.further.trials import LOOK, is_best, trials, variants_of
from experiments.evaluation.tables.look import lines_of
from experiments.plan.runs import Tried, TriedTask
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from experiments.settings.trials import tuned
from mobnet.core.recording import Recording
from mobnet.core.store import read_array

JOINTS = ("LL1", "LL4")
FACTS = ("steps", "seconds", "validation_loss")  # of a training


@pytest.fixture
def made(
    settings: Settings, tmp_path: Path, made_up: Callable[..., Recording], write_pair: Any
) -> tuple[Path, list[tuple[Path, Path]]]:
    """The table of the zero predictor and of the observer, and the walks that they ran on."""
    pairs = [write_pair(tmp_path, made_up(seed, 0.3)) for seed in (1, 2)]
    tried = [Tried(name, name, {}, {name: Catalogue(settings).method(name)}, {}, None, 0) for name in ("zero", "MOB")]
    for change in (1.0, 2.0):
        row = (
            Catalogue(settings)
            .method("MOB-Kalman")
            .model_copy(update={"of": "MOB", "options": {"momentum_nms": 1.0, "walk_nm": 1e5 * change}})
        )
        name = f"K-{change}"
        tried.append(
            Tried(
                "K", name, {"walk_nm": 1e5 * change}, {name: row, "MOB": Catalogue(settings).method("MOB")}, {}, None, 0
            )
        )
    level = settings.levels["all_uncertainty"]
    task = TriedTask(level, JOINTS, tuple(tried), *map(tuple, zip(*pairs, strict=True)))
    known = settings.robot, settings.plant.gravity_m_s2, settings.observer
    trials(*known, {"leg": task}, 1000.0, tmp_path / "trials")
    return tmp_path / "trials", pairs


def test_errors_are_means_over_the_walks(made: tuple[Path, list[tuple[Path, Path]]]) -> None:
    """Those of zero are the size of the truth, those of the observer its distance from the truth."""
    out, pairs = made
    rows = {(row.method, row.tried, row.joint): row for row in read_table(out.with_suffix(".csv"))}
    for joint in JOINTS:
        truths = [read_array(residual, [f"tau_ext_lp.{joint}"])[0].astype(float) for _, residual in pairs]
        observed = [read_array(residual, [f"r.{joint}"])[0].astype(float) for _, residual in pairs]
        zero = [np.sqrt(np.mean(truth**2)) for truth in truths]
        mob = [np.sqrt(np.mean((r - truth) ** 2)) for r, truth in zip(observed, truths, strict=True)]
        assert rows["zero", None, joint].rmse_nm == pytest.approx(np.mean(zero), rel=1e-4)
        assert rows["MOB", None, joint].rmse_nm == pytest.approx(np.mean(mob), rel=1e-4)
        assert rows["MOB", None, joint].std_nm == pytest.approx(np.std(mob, ddof=1), rel=1e-3)
        assert rows["MOB", None, joint].walks == 2


def test_the_table_is_the_golden_one(made: tuple[Path, Any]) -> None:
    check_golden_table(made[0].with_suffix(".csv"))


def test_one_variant_of_each_method_that_is_varied_is_the_best(made: tuple[Path, Any]) -> None:
    rows = [row for row in read_table(made[0].with_suffix(".csv")) if row.joint == "avg"]
    assert {row.method: sum(other.best for other in rows if other.method == row.method) for row in rows} == {
        "zero": 0, "MOB": 0, "K": 1,
    }  # fmt: skip
    best, other = sorted((row for row in rows if row.method == "K"), key=lambda row: -row.best)
    assert best.rmse_nm <= other.rmse_nm
    lines = made[0].with_suffix(".md").read_text().splitlines()
    assert lines[0].startswith("| Task | Method | Tried | Steps [million] | Processor time [s] | Networks |")
    assert sum("| best |" in line for line in lines) == 1


def test_of_lengths_each_has_its_best() -> None:
    """The recipe of each length is chosen by itself, by the mean over its networks."""
    tried = [("short", "a", 1.0), ("short", "a", 4.0), ("short", "b", 2.0), ("long", "a", 1.0), ("long", "b", 1.5)]
    rows = pd.DataFrame(tried, columns=["length", "tried", "rmse_nm"]).assign(task="leg", method="M", joint="avg")
    assert is_best(rows).tolist() == [False, False, True, True, False]
    assert not is_best(rows.assign(tried="")).any()


def test_a_variant_has_the_means_of_its_networks(make_rows: Callable[..., list[dict[str, Any]]]) -> None:
    """One of them diverged; the method beside them has no network."""
    rows = make_rows("M", "rate 0.1", [(0, 2.0, ""), (1, 4.0, "diverged")]) + make_rows("MOB", "", [(0, 5.0, "")])
    table = pd.DataFrame(rows).astype({"steps": "Int64"}).assign(best=0)
    changed, plain = variants_of(table).to_dict("records")
    assert (changed["networks"], changed["value"], changed["mark"]) == (2, 3.0, "diverged")
    assert changed["std_nm"] == pytest.approx(2.0**0.5)
    assert lines_of(variants_of(table), LOOK)[0] == [
        "leg", "M", "rate 0.1", "1.5", "20", "2", "-4.00", "3.00", "1.41", "diverged",
    ]  # fmt: skip
    assert pd.isna(plain["steps"])
    assert variants_of(table.assign(best=1))["mark"].tolist() == ["best", "best"]


@pytest.fixture
def make_rows() -> Callable[..., list[dict[str, Any]]]:
    """Return a function that makes the rows of means of networks: seed, error [N m] and state of each."""

    def rows(method: str, tried: str, networks: list[tuple[int, float, str]]) -> list[dict[str, Any]]:
        facts = {"steps": 1_500_000, "seconds": 20.0, "validation_loss": -4.0} if tried else dict.fromkeys(FACTS)
        place = {"task": "leg", "method": method, "tried": tried, **facts}
        return [{**place, "network_seed": seed, "rmse_nm": error, "state": state} for seed, error, state in networks]

    return rows


def test_the_grid_of_the_configuration_is_what_a_trial_says(settings: Settings) -> None:
    names = [trial.name for trial in tuned(settings.trials, settings.methods, settings.development)]
    assert len(names) == len(set(names))
