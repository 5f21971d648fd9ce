"""Claims as written: what cells share is filled in, a malformed one is named, bounds lie within each other."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.evaluation.claim import Claim, inside, read_claims, rule_text
from mobnet.evaluation.kinds import MEASURES
from mobnet.evaluation.metrics import METRICS, PUSH, PUSHED
from mobnet.evaluation.results import listed

CLAIMS = Path(__file__).parents[2] / "configs/claims.yaml"
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
