"""Table 1 tells of the networks that are trained, and they are the paper's."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from csv_files import check_golden_table, read_table

from experiments.evaluation.tables.paper.table_01 import tex_symbols
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings


@pytest.fixture
def rows_of(make_table: Callable[..., Path], settings: Settings) -> Callable[..., list[Any]]:
    """Return a function of changes of the left leg's network that makes the rows of the repository's Table 1."""

    def rows(**changes: Any) -> list[Any]:
        networks = {limb: Catalogue(settings).network("MOB-Net", limb) for limb in settings.published.table_01.rows}
        networks["LL"] = networks["LL"].model_copy(update=changes)
        return read_table(
            make_table("table_01", networks=networks, target=Catalogue(settings).method("MOB-Net").target)
        )

    return rows


def test_every_limb_of_the_paper_has_its_network_size_and_horizon(
    rows_of: Callable[..., list[Any]], tmp_path: Path
) -> None:
    rows = rows_of()
    check_golden_table(tmp_path / "table_01.csv")
    assert [row.limb for row in rows] == ["RL", "LL", "RA", "LA", "W", "V"]
    for row in rows:
        assert row.architecture == row.architecture_published
        assert row.parameters == row.parameters_published
        assert row.horizon_steps == row.horizon_published


def test_inputs_are_counted_and_named_as_in_the_paper(rows_of: Callable[..., list[Any]]) -> None:
    _, leg, *_, base = rows_of()
    assert (leg.inputs, leg.input_count) == ("Q^LL, T^LL, U^V", 6 + 6 + 6 + 12)
    assert (base.inputs, base.input_count) == ("Q^RL, Q^LL, Q^RA, Q^LA, Q^W, U^V", 2 * (6 + 6 + 8 + 8 + 3) + 12)
    assert leg.target == "r^LL - tau_ext^LL"


def test_another_network_gives_another_row(rows_of: Callable[..., list[Any]]) -> None:
    row = rows_of(hidden=10)[1]
    assert row.architecture == "GRU[30, 10]-Linear[10, 12]"
    assert row.parameters == 3 * 10 * (30 + 10 + 2) + 12 * (10 + 1)


def test_symbols_become_tex() -> None:
    assert tex_symbols("r^LL - tau_ext^LL") == r"$r^{LL} - \tilde\tau_{\mathrm{ext}}^{LL}$"
    assert tex_symbols("Q^W, U^V") == "$Q^{W}, U^{V}$"
