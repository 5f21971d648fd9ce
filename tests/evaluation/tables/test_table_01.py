"""Table 1 tells of the networks that are trained, and they are the paper's."""

from pathlib import Path
from typing import Any

import pytest
from csv_files import read_table

from mobnet.evaluation.tables.table_01 import table_01, tex_symbols

REPO = Path(__file__).parents[3]


@pytest.fixture
def rows(tmp_path: Path, full_config: dict[str, Any]) -> list[Any]:
    """Table 1 of the repository's configuration."""
    table_01(full_config | {"published": str(REPO / "configs/legacy_published.yaml")}, tmp_path)
    return read_table(tmp_path / "table_01.csv")


def test_every_limb_of_the_paper_has_its_network_size_and_horizon(rows: list[Any]) -> None:
    assert [row.limb for row in rows] == ["RL", "LL", "RA", "LA", "W", "V"]
    for row in rows:
        assert row.architecture == row.architecture_published
        assert row.parameters == row.parameters_published
        assert row.horizon_steps == row.horizon_published


def test_inputs_are_counted_and_named_as_in_the_paper(rows: list[Any]) -> None:
    leg, base = rows[1], rows[5]
    assert (leg.inputs, leg.input_count) == ("Q^LL, T^LL, U^V", 6 + 6 + 6 + 12)
    assert (base.inputs, base.input_count) == ("Q^RL, Q^LL, Q^RA, Q^LA, Q^W, U^V", 2 * (6 + 6 + 8 + 8 + 3) + 12)
    assert leg.target == "r^LL - tau_ext^LL"


def test_another_network_gives_another_row(tmp_path: Path, full_config: dict[str, Any]) -> None:
    networks = full_config["networks"] | {"LL": full_config["networks"]["LL"] | {"hidden": 10}}
    table_01(full_config | {"published": str(REPO / "configs/legacy_published.yaml"), "networks": networks}, tmp_path)
    row = read_table(tmp_path / "table_01.csv")[1]
    assert row.architecture == "GRU[30, 10]-Linear[10, 12]"
    assert row.parameters == 3 * 10 * (30 + 10 + 2) + 12 * (10 + 1)


def test_symbols_become_tex() -> None:
    assert tex_symbols("r^LL - tau_ext^LL") == r"$r^{LL} - \tilde\tau_{\mathrm{ext}}^{LL}$"
    assert tex_symbols("Q^W, U^V") == "$Q^{W}, U^{V}$"
