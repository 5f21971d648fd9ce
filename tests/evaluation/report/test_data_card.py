"""The data card is current, and names every column of the files once."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.config import resolve
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed, Truth, recording_columns
from mobnet.evaluation.report.data_card import (
    CARD,
    CONFIG,
    DRAWN,
    card,
    column_rows,
    columns,
    drawn,
    field_texts,
    sizes,
)

REPO = Path(__file__).parents[3]


@pytest.fixture
def repository(full_config: dict[str, Any]) -> dict[str, Any]:
    """The repository's configuration at its default scale."""
    return resolve({**full_config, "scale": "default"})


def test_the_card_is_current(repository: dict[str, Any], layout: JointLayout) -> None:
    remedy = "python -m mobnet.evaluation.report.data_card writes it"
    assert (REPO / CARD).read_text() == card(repository, layout), remedy
    assert (REPO / CONFIG).is_file()


def test_every_field_is_explained_and_every_column_counted(repository: dict[str, Any], layout: JointLayout) -> None:
    groups = recording_columns(layout)
    assert {*field_texts(Sensed), *field_texts(Truth)} == set(groups)
    tables = "".join(columns(repository, layout))
    counts = [int(row.split(" | ")[2]) for row in re.findall(r"^\| (?:`\w+`)? ?\|.*$|^\| `.*$", tables, re.MULTILINE)]
    assert sum(counts) == sum(map(len, groups.values())) + 2 * layout.nv


def test_a_long_group_shows_its_first_and_last_column() -> None:
    found = [(f"q.A{i}", "rad", "joint") for i in range(9)] + [("q.x", "m", "world")]
    rows = list(column_rows("q", found, "position"))
    assert rows[0] == ["`q`", "`q.A0`, `q.A1`, `q.A2`, ..., `q.A8`", "9", "rad", "joint", "position"]
    assert rows[1] == ["", "`q.x`", "1", "m", "world", ""]


def test_texts_are_those_of_the_docstring() -> None:
    assert field_texts(Truth)["contact"] == "1 where the left, right foot touches the ground (T, 2)."
    assert "  " not in "".join(field_texts(Sensed).values())


def test_minutes_are_recordings_times_their_length() -> None:
    train = {"walk": {"scenario": "w", "level": "l", "shards": 6, "shard_s": 300.0}}
    text = sizes({"s": {"train": train, "test": {"shards": 3, "shard_s": 60.0}}})
    assert "| s | walk | w | l | 6 | 30 |" in text
    assert "| s | test | each test | as its table asks | 3 | 3 |" in text


def test_every_number_of_a_section_is_in_its_table(repository: dict[str, Any]) -> None:
    tables = list(drawn(repository))
    for section in DRAWN:
        table = next(text for text in tables if text.startswith(f"\n### `{section}`"))
        for key, value in repository[section].items():
            assert f"| `{key}` | {json.dumps(value)} |" in table
