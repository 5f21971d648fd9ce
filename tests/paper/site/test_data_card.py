"""The data card is current, and names every column of the files once."""

import json
import re
from pathlib import Path

import pytest
import yaml
from paper_settings import settings_at

from experiments.site.data_card import (
    CARD,
    DRAWN,
    NAMED,
    card,
    column_rows,
    columns,
    drawn,
    field_texts,
    sizes,
)
from mobnet.core.columns import recording_columns, residual_columns
from mobnet.core.recording import Sensed, Truth

REPO = Path(__file__).parents[3]
SETTINGS = settings_at()


def test_the_card_is_current() -> None:
    remedy = "python -m experiments.site data writes it"
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


def test_a_set_has_its_recordings_and_their_minutes_at_each_scale() -> None:
    text = sizes(SETTINGS)
    assert "| set | scenario | level | smoke | quick | default | paper |" in text
    assert "| walk | random_walk | all_uncertainty | 2 x 0.5 | 7 x 5 | 8 x 5 | 12 x 5 |" in text
    assert "| test | each test | as its table asks | 1 x 0.167 | 4 x 0.5 | 12 x 0.5 | 15 x 0.5 |" in text
    assert "| test | leg_sines | as its table asks | - | 4 x 1 | 12 x 1 | 15 x 1 |" in text


@pytest.mark.parametrize(("section", "table"), list(zip(DRAWN, drawn(SETTINGS), strict=True)), ids=list(DRAWN))
def test_every_number_of_a_section_is_in_its_table_or_in_the_file_that_it_names(section: str, table: str) -> None:
    assert table.startswith(f"\n### `{section}`")
    written = SETTINGS.model_dump(mode="json", exclude_unset=True)
    for part in section.split("."):
        written = written[part]
    file = yaml.safe_load((REPO / NAMED[section]).read_text()) if section in NAMED else {}
    for key, value in written.items():
        if section in NAMED:
            assert f"`{key}`" in table
        else:
            assert f"| `{key}` | {json.dumps(value)} |" in table
    assert section not in NAMED or section in file
