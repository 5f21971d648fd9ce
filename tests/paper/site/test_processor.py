"""What another kind of processor changes: the comparison of two runs, and what the note says of it."""

from pathlib import Path

import pandas as pd
import pytest

from experiments.site.processor import BLOCK, KEPT, NOTE, compared, keep, log, told
from experiments.site.snapshot import run_renewal
from mobnet.core.errors import DataError

ROOT = Path(__file__).parents[3]


def claims(**changed: dict[str, object]) -> pd.DataFrame:
    """Return a table of four claims, of which some have other cells."""
    rows = []
    for name in ("a", "b", "c", "d"):
        row = {"claim": name, "statement": name, "unit": "-", "value": 1.0, "low": 0.5, "high": 1.5, "verdict": "open"}
        rows.append({**row, **changed.get(name, {})})
    return pd.DataFrame(rows)


def test_numbers_and_verdicts_that_differ_are_counted() -> None:
    here = claims(b={"verdict": "reproduced"}, c={"verdict": "reproduced"})
    there = claims(a={"value": 1.1}, b={"value": 1.2}, c={"value": 1.3, "verdict": "not reproduced"})
    text = told(compared(here, there))
    assert text.startswith(
        "3 of 4 claims have another number; half of these moved by less than 0.40 of half their interval."
    )
    assert "2 have another verdict; 1 of these are decided in both runs:" in text
    assert "| b | 1.00 [0.50, 1.50] | reproduced | 1.20 [0.50, 1.50] | open |" in text


def test_claims_without_a_number_are_compared_by_their_verdicts() -> None:
    nothing = {"value": float("nan"), "low": float("nan"), "high": float("nan"), "verdict": "not measured"}
    assert told(compared(claims(a=nothing), claims(a=nothing))).startswith("0 of 4 claims have another number. 0 have")


def test_runs_with_other_claims_are_refused() -> None:
    with pytest.raises(DataError, match="claim d, which one run has, is not accepted; accepted: runs of one commit"):
        compared(claims(), claims().head(3))


def test_a_call_without_tables_is_refused(caplog: pytest.LogCaptureFixture) -> None:
    assert run_renewal(lambda: keep([]), log) == 1
    assert "0 words is not accepted; accepted: the folder of the tables" in caplog.text


def test_the_note_says_what_is_kept() -> None:
    assert told(pd.read_csv(ROOT / KEPT)) in (ROOT / NOTE).read_text()
    assert f"<!-- {BLOCK} -->" in (ROOT / NOTE).read_text()
