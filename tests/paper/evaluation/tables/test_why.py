"""Why a hit is hidden: what networks show of it, robot by robot, and by which inputs it comes in."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden_table
from paper_settings import STATISTICS

from experiments.evaluation.measure.learning.explained import ALL, NETWORKS, PATH, spread_of
from experiments.evaluation.measure.learning.paths import EVERY, GROUPS
from experiments.evaluation.tables.further.why import TAKEN, UNITS, write_why
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.settings.trials import explained
from mobnet.core.errors import ConfigError
from mobnet.core.rows import read_texts

SEEN = ("why_walk", "MOB-Net", "soap")
BROUGHT = (("robot_1", 0.2), ("robot_1", 0.4), ("robot_2", 0.5))  # share of a hit of each network


def test_a_number_is_a_mean_over_robots_and_each_robot_one_over_its_networks(
    settings: Settings, tmp_path: Path
) -> None:
    networks = {"robot_1": [2.0, 3.0], "robot_2": [4.0]}
    taught: list[tuple[Any, ...]] = []
    for measure in UNITS:
        for robot, values in networks.items():
            taught += [(*SEEN, measure, robot, value) for value in values]
    taken: list[tuple[Any, ...]] = []
    for inputs in GROUPS:
        taken += [("MOB-Net", inputs, robot, value) for robot, value in BROUGHT]
    frame = pd.DataFrame(taught, columns=[*NETWORKS, "measure", "robot", "value"])
    write_why(tmp_path / "why", frame, pd.DataFrame(taken, columns=TAKEN), settings.trials.why, STATISTICS)
    check_golden_table(tmp_path / "why.csv")
    rows = read_texts(tmp_path / "why.csv")
    for measure in UNITS:
        own = {(row["robot"], row["network"]): row for row in rows if row["measure"] == measure}
        single = {("robot_1", "0"): 2.0, ("robot_1", "1"): 3.0, ("robot_2", "0"): 4.0}
        assert {name: float(row["value"]) for name, row in own.items()} == {**single, (ALL, ""): 3.25}
        assert float(own[ALL, ""]["low"]) < 2.5 < 4.0 < float(own[ALL, ""]["high"])
    (every,) = [row for row in rows if row["measure"] == PATH and row["inputs"] == EVERY and row["robot"] == ALL]
    assert float(every["value"]) == pytest.approx(0.4)
    assert "Share of a hit that the prediction of MOB-Net takes, by inputs: all inputs 0.40" in (
        (tmp_path / "why.md").read_text()
    )


def test_the_spread_of_seeds_is_apart_from_that_of_robots() -> None:
    """Drawn numbers with known spreads; items with one network, or one robot, say nothing of it."""
    rng = np.random.default_rng(7)
    drawn: list[dict[str, list[float]]] = []
    for _ in range(2000):
        of_robots = rng.normal(0.0, 0.3, 2)
        drawn.append({name: list(mean + rng.normal(0.0, 0.1, 2)) for name, mean in zip("ab", of_robots, strict=True)})
    alone: list[dict[str, list[float]]] = [{"a": [9.0], "b": [1.0]}, {"a": [9.0, 1.0]}]
    pairs, networks, robots = spread_of([*drawn, *alone])
    assert pairs == 4000
    assert networks == pytest.approx(0.1, rel=0.05)
    assert robots == pytest.approx(np.hypot(0.3, 0.1 / np.sqrt(2.0)), rel=0.05)


def test_each_robot_has_the_networks_of_its_rows(settings: Settings) -> None:
    trial = settings.trials.why
    given = settings.trials, settings.methods
    alone = {one.name for one in explained(*given, "robot_6")}
    every = {one.name for one in explained(*given, "robot_1")}
    assert alone < every
    late = list(explained(*given, "robot_1", "why_late"))
    assert {one.base for one in late} == set(trial.rows[3].methods)
    assert all(one.method.network["data"] == "why_late" for one in late)


def test_the_trial_judges_a_robot_on_the_level_of_its_set(settings: Settings) -> None:
    plan = make_plan(settings, with_pdf=False)
    product = next(one for one in plan.trials if one.name == "why")
    robots: Any = product.call.arguments["robots"]
    for own in robots:
        walked = {recording.parent.name for recording in own.taught.hits.recordings}
        name = own.data.removeprefix("why_")
        assert walked == {own.robot if name in ("walk", "plain") else f"{own.robot}_robots_{name}"}
        assert bool(own.twins) == (own.data == "why_walk")


@pytest.mark.parametrize(("sections", "text"), [
    ({"joint": "RL3"}, "trials.why.joint: joint of the network: 'RL3' is not accepted"),
    ({"path_set": "walk_test"}, "trials.why.path_set"),
    ({"walk": "walk_test"}, "trials.why.walk: scenario apart from tests and training: 'walk_test' is not accepted"),
])  # fmt: skip
def test_what_does_not_fit_is_told(sections: dict[str, Any], text: str) -> None:
    with pytest.raises(ConfigError) as told:
        load_settings(overrides={"trials": {"why": sections}})
    assert text in str(told.value)
