"""The table of the training sets says what the recordings hold."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import check_golden, check_golden_table, read_table

from experiments.evaluation.measure.data.steps import WalkedSteps
from experiments.evaluation.tables.further.data import commanded, extent
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json
from mobnet.robot.nominal import NominalModel

Sets = dict[str, list[Path]]
Facts = dict[tuple[str, str, str], Any]


@pytest.fixture
def facts(make_table: Callable[..., Path], data_sets: Sets) -> Facts:
    table = make_table("data", sets={name: data_sets[name] for name in ("walk", "motion")})
    check_golden_table(table)
    return {(row.set, row.quantity, row.part or ""): row for row in read_table(table)}


def test_numbers_are_those_of_the_recordings(facts: Facts) -> None:
    assert facts["walk", "samples", ""].value == 4000
    assert facts["walk", "duration", ""].value == pytest.approx(40 / 60)
    assert facts["walk", "duration", ""].published == 60.0
    assert facts["walk", "falls", ""].value == 0
    assert facts["walk", "episodes", ""].value == 4
    assert facts["walk", "time on terrain", "checks"].value == 0.5
    # only the motion stands half of the time
    assert facts["walk", "time standing", ""].value == 0.0
    assert facts["motion", "time standing", ""].value == 0.5
    assert facts["motion", "time standing", ""].published == 0.5
    assert facts["motion", "steps", ""].value < facts["walk", "steps", ""].value
    # commands stand beside the ends of Table 2
    low, high = (facts["walk", f"{end} command", "step_x"] for end in ("smallest", "largest"))
    assert (low.published, high.published) == (-0.15, 0.2)
    assert -0.15 <= low.value < high.value <= 0.2
    assert facts["walk", "largest command", "turn"].published == 20.0
    assert facts["walk", "largest command", "turn"].unit == "deg"
    assert facts["walk", "largest command", "foot_height"].published == 0.07


def test_joints_are_left_to_the_csv(facts: Facts, tmp_path: Path) -> None:
    assert ("walk", "lower limit", "LA1") in facts
    text = (tmp_path / "data.md").read_text()
    assert "LA1" not in text
    assert "joint range visited, limb LA" in text
    assert text.splitlines()[0].startswith("|  | walk | motion | Original |")


def test_clearance_is_the_smallest_that_was_noted_and_overlaps_have_their_share_of_the_time(
    tmp_path: Path, data_sets: Sets
) -> None:
    stems = []
    for k, clearance in enumerate((0.05, 0.02)):
        stems.append(tmp_path / f"s{k}")
        write_json(
            stems[-1].with_suffix(".json"),
            {
                **read_json(data_sets["motion"][k].with_suffix(".json")), "rows": 5000, "rate_hz": 1000.0,
                "clearance_min_m": clearance, "self_collisions": 10 * k,
            },
        )  # fmt: skip
    found = {(quantity, part): value for quantity, part, value, _ in extent(stems, ["checks"], 50.0)}
    assert found["smallest self-clearance", ""] == 0.02
    assert found["time in self-collision", ""] == pytest.approx(10 / (2 * 5.0 * 50.0))


def test_a_command_never_given_has_no_ratio(
    monkeypatch: pytest.MonkeyPatch, settings: Settings, nominal: NominalModel, data_sets: Sets
) -> None:
    monkeypatch.setattr(WalkedSteps, "follows", lambda self, column: np.full(len(self), column != 2))
    found = commanded(settings.commands, settings.walking.foot_spacing_m, data_sets["walk"][:1], nominal)
    assert [part for quantity, part, _, _ in found if "over" in quantity] == ["step_x", "step_y"]


def test_a_missing_recording_is_named(tmp_path: Path, make_table: Callable[..., Path]) -> None:
    with pytest.raises(DataError, match=r"nowhere\.json: file is missing"):
        make_table("data", sets={"walk": [tmp_path / "nowhere"]})


def test_coverage_is_the_golden_one(
    make_table: Callable[..., Path], settings: Settings, evaluation: Evaluation, data_sets: Sets
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    ports = settings.robot.networks[evaluation.coverage.limb]
    check_golden(make_table("coverage", ports=ports, training=training, tests=[data_sets["test"]]))
