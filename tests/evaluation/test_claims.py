"""Claims: bounds decide, a failing claim is a row, a malformed one is an error."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.evaluation.claims import Claim, Verdict, claims, inside, read_claims, rule_text, verdict_of
from mobnet.evaluation.rows import read_rows

CLAIMS = Path(__file__).parents[2] / "configs/claims.yaml"
NARROW_IN_WIDE = [(claim.reproduced, claim.direction) for claim in read_claims(CLAIMS)]


@pytest.mark.parametrize(("value", "verdict"), [(1.5, "reproduced"), (2.5, "direction only"), (9.0, "not reproduced")])
def test_verdict_follows_the_bounds(value: float, verdict: str) -> None:
    claim = Claim("a", "", "", "value", (("i", "m", "avg"),), "N m", None, (1.0, 2.0), (None, 3.0))
    assert verdict_of(value, claim) == verdict
    assert verdict_of(value, replace(claim, reproduced=(None, None))) == "reproduced"


@pytest.mark.parametrize(("narrow", "wide"), NARROW_IN_WIDE)
def test_what_is_reproduced_also_points_the_papers_way(narrow: Any, wide: Any) -> None:
    assert wide[0] is None or (narrow[0] is not None and narrow[0] >= wide[0])
    assert wide[1] is None or (narrow[1] is not None and narrow[1] <= wide[1])


def test_numbers_are_made_of_means_over_runs(tmp_path: Path, config: dict[str, Any], scores_csv: Path) -> None:
    claims(config, CLAIMS, scores_csv, tmp_path)
    rows = {row.claim: row for row in read_rows(tmp_path / "claims.csv", Verdict)}
    assert rows["mob-net-cut"].value == pytest.approx(1 - 1.5 / 19.0, rel=1e-4)
    assert rows["mob-net-at-floor"].value == pytest.approx(1.5 / 1.2, rel=1e-4)
    assert rows["mob-uncertain"].value == pytest.approx(19.0)
    assert rows["mob-net-at-floor"].seed_count == 6
    assert rows["mob-uncertain"].seed_count == 3
    assert rows["fts-e2e-smooth"].verdict == "not reproduced"
    assert rows["noise-floor"].verdict == "reproduced"


def test_every_claim_is_a_row_of_every_file(tmp_path: Path, config: dict[str, Any], scores_csv: Path) -> None:
    claims(config, CLAIMS, scores_csv, tmp_path)
    known = read_claims(CLAIMS)
    assert [row.claim for row in read_rows(tmp_path / "claims.csv", Verdict)] == [claim.name for claim in known]
    for name in ("claims.tex", "claims.md"):
        text = (tmp_path / name).read_text()
        assert sum(text.count(word) for word in (" reproduced ", "direction only")) >= len(known) - 1


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"quantity": "sum"}, r"quantity: 'sum' is not accepted; accepted: cut, ratio, value"),
        ({"bound": 1}, r"key: 'bound' is not accepted"),
        ({"cells": [["ideal", "MOB", "avg"]] * 2}, r"2 cells; value takes 1"),
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
    assert [rule_text(b) for b in ((None, 2.0), (1.0, None), (1.0, 2.5))] == ["at most 2", "at least 1", "1 to 2.5"]
