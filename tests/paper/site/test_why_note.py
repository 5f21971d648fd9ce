"""The note on training has the numbers of the trial of why a hit is hidden, and names every prediction that missed."""

from pathlib import Path

import pytest

from experiments.evaluation.measure.learning.explained import read_why
from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import write_csv
from experiments.settings.settings import Settings
from experiments.settings.table_columns import WHY
from experiments.site.why_note import CLAIMS, NOTE, predictions_of, verdict_of, why_blocks
from mobnet.core.errors import DataError

ROOT = Path(__file__).parents[3]


def test_the_note_says_what_the_kept_table_has(settings: Settings) -> None:
    """Where the table is missing this fails: the note tells of it."""
    text = (ROOT / NOTE).read_text(encoding="utf-8")
    for name, block in why_blocks(settings, ROOT / settings.evaluation.why_share.data).items():
        assert f"<!-- {name} -->\n{block.strip()}\n<!-- /{name} -->" in text


def test_another_number_in_the_table_is_another_note(settings: Settings, tmp_path: Path) -> None:
    rows = read_why(ROOT / settings.evaluation.why_share.data)
    rows.loc[rows["measure"] == "share", "value"] *= 1.1
    write_csv(tmp_path / "why.csv", WHY, records_of(rows, WHY))
    now, then = (why_blocks(settings, path / "why.csv") for path in (ROOT / "docs/trials", tmp_path))
    assert {name for name in now if now[name] != then[name]} >= {"why_predicted"}


def test_a_table_without_the_networks_of_a_prediction_is_refused(settings: Settings, tmp_path: Path) -> None:
    write_csv(tmp_path / "why.csv", WHY, [])
    with pytest.raises(DataError, match=r"why_walk, MOB-Net-noimu, soap: these networks are missing"):
        why_blocks(settings, tmp_path / "why.csv")


def test_the_predictions_are_those_that_the_note_and_the_claims_made(settings: Settings) -> None:
    text = " ".join((ROOT / NOTE).read_text(encoding="utf-8").split())
    assert "| nothing: the original's inputs | about a half | 1 | below 1.6 | hides more of the hit |" in text
    assert "| acceleration (`MOB-Net-noacc`) | more | 1.05 at most | | |" in text
    assert "(`MOB-Net-noimu`) | 0.75 to 1 | 1.15 at most | 1.6 to 3 (original: 2.0) | shows more of the hit |" in text
    bounds = [one.bounds for one in predictions_of(settings)]
    assert bounds == [
        (0.75, 1.0), (1.0, None), (None, 1.15), (1.6, 3.0), (1.0, None), (1.0, None), (1.0, None), (None, 1.05),
        (None, 1.6), (None, 1.0),
    ]  # fmt: skip
    assert len(CLAIMS) == len([name for name in settings.claims if name.startswith(("imu-", "acc-"))])


@pytest.mark.parametrize(("value", "ends", "verdict"), [
    (3.5, (3.1, 3.9), "missed"),
    (3.2, (2.9, 3.5), "open, outside"),
    (2.9, (2.6, 3.2), "open"),
    (2.0, (1.7, 2.3), "held"),
])  # fmt: skip
def test_a_prediction_is_judged_by_its_interval(value: float, ends: tuple[float, float], verdict: str) -> None:
    assert verdict_of(Number(value, *ends), (1.6, 3.0)) == verdict
