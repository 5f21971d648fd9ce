"""The paper's numbers agree with one another wherever it prints their averages."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.evaluation.number.published import published_row, published_value, read_published

CONFIGS = Path(__file__).parents[3] / "configs"
PUBLISHED = CONFIGS / "legacy_published.yaml"
TABLES = yaml.safe_load(PUBLISHED.read_text())


def leg_rows() -> list[Any]:
    """Return every row of six leg joints and their printed average."""
    table_05 = [row for methods in TABLES["table_05"]["rows"].values() for row in methods.values()]
    walked = [row for n in ("07", "10", "11") for row in TABLES[f"table_{n}"]["rmse_nm"].values()]
    return [*table_05, *walked]


@pytest.mark.parametrize("row", leg_rows())
def test_average_of_the_leg_is_the_mean_of_its_joints_as_rounded(row: list[float]) -> None:
    assert np.mean(row[:-1]) == pytest.approx(row[-1], abs=0.006)


def upper_rows() -> list[Any]:
    """Return every row of Tables 6 and 8 in full."""
    sets = TABLES["table_06"]["data_sets"].values()
    table_06 = [row for levels in sets for methods in levels.values() for row in methods.values()]
    table_08 = [row for methods in TABLES["table_08"]["rmse"].values() for row in methods.values()]
    return [row for row in [*table_06, *table_08] if None not in row]


@pytest.mark.parametrize("row", upper_rows())
def test_averages_of_upper_body_and_base_are_means_of_their_joints(row: list[float]) -> None:
    for members, average in ((slice(0, 11), 11), (slice(12, 15), 15), (slice(16, 19), 19)):
        assert np.mean(row[members]) == pytest.approx(row[average], abs=0.011)


@pytest.mark.parametrize("method", TABLES["table_09"]["detected"])
def test_detections_add_up_and_delays_average(method: str) -> None:
    *detected, total = TABLES["table_09"]["detected"][method]
    *delays, mean = TABLES["table_09"]["delay_ms"][method]
    assert sum(detected) == total
    assert np.mean([delay for delay in delays if delay is not None]) == pytest.approx(mean, abs=0.1)


def test_published_value_is_the_printed_one() -> None:
    entry = read_published(PUBLISHED, "table_05")
    assert published_value(entry, "all_uncertainty", "MOB-Net", "avg") == pytest.approx(1.31)
    assert published_value(entry, "all_uncertainty", "MOB-fric", "avg") is None
    assert published_value(entry, "all_uncertainty", "MOB", "RL1") is None
    entry = read_published(PUBLISHED, "table_06")
    row = published_row(entry, "data_sets.left_hand_load_30n.all_uncertainty", "MOB-Net")
    assert (row["W1"], row["avg V ang"]) == pytest.approx((2.50, 3.84))
    assert published_row(entry, "data_sets.left_hand_load_30n.all_uncertainty", "FTS-e2e") == {}
    with pytest.raises(
        ConfigError, match=r"'hand' is not accepted; accepted: collision_free_motion, left_hand_load_10n"
    ):
        published_row(entry, "data_sets.hand", "MOB")


def test_a_short_row_and_an_unknown_table_are_named(tmp_path: Path) -> None:
    broken = {"table_05": {"joints": ["LL1", "LL2"], "rows": {"ideal": {"MOB": [1.0]}}}}
    (tmp_path / "p.yaml").write_text(yaml.safe_dump(broken))
    with pytest.raises(ConfigError, match=r"table_05\.rows\.ideal\.MOB: 1 numbers for 2 joints"):
        read_published(tmp_path / "p.yaml", "table_05")
    with pytest.raises(ConfigError, match=r"'table_99' is not accepted; accepted: table_05"):
        read_published(tmp_path / "p.yaml", "table_99")
