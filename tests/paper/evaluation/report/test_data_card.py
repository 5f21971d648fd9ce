"""The data card is current, and names every column of the files once."""

import json
import re
from pathlib import Path

import pytest
from paper_settings import settings_at

from experiments.evaluation.report.data_card import CARD, DRAWN, card, column_rows, columns, drawn, field_texts, sizes
from mobnet.core.columns import recording_columns, residual_columns
from mobnet.core.recording import Sensed, Truth

REPO = Path(__file__).parents[4]
SETTINGS = settings_at()


def test_the_card_is_current() -> None:
    remedy = "python -m experiments.evaluation.report.data_card writes it"
    assert (REPO / CARD).read_text() == card(SETTINGS), remedy


def test_every_field_is_explained_and_every_column_counted() -> None:
    layout = SETTINGS.layout
    groups = recording_columns(layout)
    assert {*field_texts(Sensed), *field_texts(Truth)} == set(groups)
    tables = "".join(columns(layout, SETTINGS.observer.gain_hz))
    counts = [int(row.split(" | ")[2]) for row in re.findall(r"^\| (?:`\w+`)? ?\|.*$|^\| `.*$", tables, re.MULTILINE)]
    assert sum(counts) == sum(map(len, groups.values())) + len(residual_columns(layout, labelled=True))


def test_a_long_group_shows_its_first_and_last_column() -> None:
    found = [(f"q.A{i}", "rad", "joint") for i in range(9)] + [("q.x", "m", "world")]
    rows = list(column_rows("q", found, "position"))
    assert rows[0] == ["`q`", "`q.A0`, `q.A1`, `q.A2`, ..., `q.A8`", "9", "rad", "joint", "position"]
    assert rows[1] == ["", "`q.x`", "1", "m", "world", ""]


def test_texts_are_those_of_the_docstring() -> None:
    assert field_texts(Truth)["contact"] == "1 where the left, right foot touches the ground (T, 2)."
    assert "  " not in "".join(field_texts(Sensed).values())


def test_minutes_are_recordings_times_their_length() -> None:
    text = sizes(SETTINGS)
    assert "| paper | walk | random_walk | all_uncertainty | 12 | 60 |" in text
    assert "| default | test | each test | as its table asks | 12 | 6 |" in text
    assert "| default | test | leg_sines | as its table asks | 12 | 12 |" in text
    assert "| default | test | each test of a robot | as its table asks | 4 | 2 |" in text
    assert "| default | test | long_walk | as its table asks | 4 | 40 |" in text


@pytest.mark.parametrize(("section", "table"), list(zip(DRAWN, drawn(SETTINGS), strict=True)), ids=list(DRAWN))
def test_every_number_of_a_section_is_in_its_table(section: str, table: str) -> None:
    assert table.startswith(f"\n### `{section}`")
    written = SETTINGS.model_dump(mode="json", exclude_unset=True)
    for part in section.split("."):
        written = written[part]
    for key, value in written.items():
        assert f"| `{key}` | {json.dumps(value)} |" in table
