"""The paper's numbers agree with one another wherever it prints their averages."""

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np
import pytest

from experiments.evaluation.number.number import published_row, published_value
from experiments.settings.published import PublishedTable
from experiments.settings.settings import Settings

Tables = Mapping[str, PublishedTable]


@pytest.fixture
def tables(settings: Settings) -> Tables:
    return settings.published.tables


def rows_of(table: PublishedTable, *places: str) -> list[Sequence[float]]:
    """Return the rows of some places, or of all, in which no number is missing."""
    rows = chain.from_iterable(table.numbers[place].values() for place in places or table.numbers)
    return [[number for number in row if number is not None] for row in rows if None not in row]


def test_average_of_the_leg_is_the_mean_of_its_joints_as_rounded(tables: Tables) -> None:
    walked = (rows_of(tables[name], "rmse_nm") for name in ("table_07", "table_10", "table_11"))
    rows = [*rows_of(tables["table_05"]), *chain.from_iterable(walked)]
    assert len(rows) == 13
    for row in rows:
        assert np.mean(row[:-1]) == pytest.approx(row[-1], abs=0.006), row


def test_averages_of_upper_body_and_base_are_means_of_their_joints(tables: Tables) -> None:
    rows = [*rows_of(tables["table_06"]), *rows_of(tables["table_08"])]
    assert len(rows) == 12
    for row in rows:
        for members, average in ((slice(0, 11), 11), (slice(12, 15), 15), (slice(16, 19), 19)):
            assert np.mean(row[members]) == pytest.approx(row[average], abs=0.011), row


def test_detections_add_up_and_delays_average(tables: Tables) -> None:
    numbers = tables["table_09"].numbers
    for method, (*detected, total) in numbers["detected"].items():
        *delays, mean = numbers["delay_ms"][method]
        assert sum(map(float, filter(None, detected))) == total
        assert np.mean([delay for delay in delays if delay is not None]) == pytest.approx(mean, abs=0.1)


def test_published_value_is_the_printed_one(tables: Tables) -> None:
    table = tables["table_05"]
    assert published_value(table, "all_uncertainty", "MOB-Net", "avg") == 1.31
    assert published_value(table, "all_uncertainty", "MOB-fric", "avg") is None
    assert published_value(table, "all_uncertainty", "MOB", "RL1") is None
    table, place = tables["table_06"], "left_hand_load_30n.all_uncertainty"
    row = published_row(table, place, "MOB-Net")
    assert (row["W1"], row["avg V ang"]) == (2.50, 3.84)
    assert published_row(table, place, "FTS-e2e") == published_row(table, "hand", "MOB") == {}
