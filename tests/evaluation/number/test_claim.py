"""Claims as written: what cells share is filled in, a malformed one is named, bounds lie within each other."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mobnet.evaluation.number.claim import Claim, inside, read_claims, rule_text

from mobnet.core.errors import ConfigError
from mobnet.evaluation.measure.metrics import METRICS, PUSH, PUSHED
from mobnet.evaluation.measure.results import listed
from mobnet.evaluation.measure.trainings import MEASURES
from mobnet.evaluation.number.published import published_row, read_published
from mobnet.evaluation.number.quantities import QUANTITIES

CLAIMS = Path(__file__).parents[3] / "configs/claims.yaml"
PUBLISHED = CLAIMS.with_name("legacy_published.yaml")
TABLES = {  # scenario -> table and place of its methods
    "forward_walk": [("table_05", "rows.{}")],
    "hip_pitch_step": [("figure_06", "rows.{}")],
    "motion_test": [("table_06", "data_sets.collision_free_motion.{}"), ("table_08", "rmse.collision_free_motion")],
    "hand_load_10": [("table_06", "data_sets.left_hand_load_10n.{}")],
    "hand_load_30": [("table_06", "data_sets.left_hand_load_30n.{}")],
    "walk_test": [("table_07", "rmse_nm"), ("table_10", "rmse_nm")],
    "knee_swing": [("table_11", "rmse_nm"), ("figure_10", "rows.knee_swing")],
    "hand_wrench": [("table_08", "rmse.external_wrench_on_hand")],
}
ENTRIES = {table: read_published(PUBLISHED, table) for places in TABLES.values() for table, _ in places}
COLUMNS = {"LL": "avg", "W+LA": "avg W+LA", "W+RA": "avg W+RA", "V1+V2+V3": "avg V lin", "V4+V5+V6": "avg V ang"}
IN_WORDS = {"support-mob-net-growth", "support-fts-e2e-growth"}  # "approximately 1 Nm"
IN_WORDS |= {"size-mob-net", "size-fts-e2e", "data-mob-net", "data-fts-e2e"}  # "decreases as"
KNOWN = {*METRICS, *MEASURES, PUSHED, *(PUSH.format(k) for k in range(1, 7))}


@pytest.mark.parametrize("claim", read_claims(CLAIMS), ids=lambda claim: claim.name)
def test_what_is_reproduced_also_points_the_papers_way(claim: Claim) -> None:
    (low, high), (lowest, highest) = claim.reproduced, claim.direction
    assert lowest is None or (low is not None and low >= lowest)
    assert highest is None or (high is not None and high <= highest)


@pytest.mark.parametrize("claim", read_claims(CLAIMS), ids=lambda claim: claim.name)
def test_the_papers_own_number_would_count_as_reproduced(claim: Claim) -> None:
    assert claim.published is None or inside(claim.published, claim.reproduced)


@pytest.mark.parametrize("claim", read_claims(CLAIMS), ids=lambda claim: claim.name)
def test_the_papers_number_follows_from_its_tables(claim: Claim) -> None:
    if claim.published is None or claim.name in IN_WORDS:
        return
    means = np.array([printed(cell) for cell in claim.cells])
    assert QUANTITIES[claim.quantity].made(means) == pytest.approx(claim.published, abs=0.006)


def printed(cell: Mapping[str, Any]) -> float:
    """Return what the paper prints in a cell, from the first of its tables that has the method and the column."""
    joint = cell["joint"] if isinstance(cell["joint"], str) else "+".join(cell["joint"])
    column = "avg" if cell["scenario"] == "knee_swing" else COLUMNS.get(joint, joint)
    for table, place in TABLES[cell["scenario"]]:
        row = published_row(ENTRIES[table], place.format(cell["level"]), cell["method"])
        if row.get(column) is not None:
            return float(row[column] or 0.0)
    raise AssertionError(f"the paper prints no {column} of {cell}")


@pytest.mark.parametrize("claim", read_claims(CLAIMS), ids=lambda claim: claim.name)
def test_every_metric_of_a_claim_is_one_that_is_made(claim: Claim) -> None:
    assert KNOWN.issuperset(name for cell in claim.cells for name in listed(cell.get("metric", [])))


def test_cells_take_what_they_do_not_say_from_what_they_share(tmp_path: Path) -> None:
    entry = yaml.safe_load(CLAIMS.read_text())["step-mob"]
    forms = [["ideal", "MOB", "LL1"], "MOB", {"method": "MOB", "metric": "roughness"}]
    entry |= {"quantity": "below", "at": {"level": "a", "metric": "b"}, "cells": forms}
    (tmp_path / "c.yaml").write_text(yaml.safe_dump({"one": entry}))
    assert read_claims(tmp_path / "c.yaml")[0].cells == (
        {"level": "ideal", "method": "MOB", "joint": "LL1", "metric": "b"},
        {"level": "a", "method": "MOB", "metric": "b"},
        {"level": "a", "method": "MOB", "metric": "roughness"},
    )


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"quantity": "sum"}, r"quantity: 'sum' is not accepted; accepted: above, below, cut"),
        ({"bound": 1}, r"key: 'bound' is not accepted"),
        ({"cells": [["ideal", "MOB", "LL"]] * 2}, r"2 cells; value takes 1"),
        ({"cells": ["MOB"], "quantity": "below"}, r"1 cells; below takes 2, 3, \.\.\."),
        ({"cells": [["MOB", "LL"]]}, r"cell \['MOB', 'LL'\] is not accepted; accepted: \[level, method, joint\]"),
        ({"at": {"limb": "LL"}}, r"key of a cell: 'limb' is not accepted; accepted: joint, level"),
        ({"reproduced": [1.0]}, r"reproduced: \[1\.0\].*\[low, high\]"),
        ({"direction": [2.0, 1.0]}, r"direction: \[2\.0, 1\.0\].*low <= high"),
    ],
)
def test_a_malformed_claim_is_named(tmp_path: Path, change: dict[str, Any], says: str) -> None:
    entry = yaml.safe_load(CLAIMS.read_text())["mob-exact"]
    (tmp_path / "c.yaml").write_text(yaml.safe_dump({"odd-claim": {**entry, **change}}))
    with pytest.raises(ConfigError, match=rf"odd-claim: {says}"):
        read_claims(tmp_path / "c.yaml")


def test_a_claim_without_a_rule_is_refused(tmp_path: Path) -> None:
    entry = yaml.safe_load(CLAIMS.read_text())["mob-exact"]
    del entry["reproduced"]
    (tmp_path / "c.yaml").write_text(yaml.safe_dump({"odd-claim": entry}))
    with pytest.raises(ConfigError, match="key 'reproduced' is missing"):
        read_claims(tmp_path / "c.yaml")


def test_bounds_are_closed_and_read_aloud() -> None:
    assert inside(1.0, (1.0, 1.0))
    assert not inside(1.01, (None, 1.0))
    assert inside(-9.0, (None, 1.0))
    bounds = [(None, 2.0), (1.0, None), (1.0, 2.5), (None, None)]
    assert [rule_text(each) for each in bounds] == ["at most 2", "at least 1", "1 to 2.5", "any"]
