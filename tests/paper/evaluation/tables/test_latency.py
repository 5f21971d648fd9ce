"""Latency: networks that keep up are told, no time is written, and slow ones are told too."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden_table, read_table

from experiments.evaluation.tables.further import latency
from experiments.settings.evaluation import Evaluation
from mobnet.core.joints import JointLayout
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.settings.plant import Rates


@pytest.mark.parametrize(("data_hz", "met"), [(1, 1.0), (10**9, 0.0)])
def test_the_share_of_stretches_within_a_tick_has_an_interval(
    data_hz: int, met: float, make_table: Callable[..., Path], layout: JointLayout, evaluation: Evaluation,
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
) -> None:  # fmt: skip
    monkeypatch.setattr(latency, "load_limb_networks", lambda networks, _: LimbNetworks([], layout))
    monkeypatch.setattr(LimbNetworks, "step", lambda _, state, sample: (state, None))
    section = evaluation.latency.model_copy(update={"stretches": 10, "ticks": 10})
    (row,) = read_table(
        make_table("latency", settings=section, rates=Rates.model_construct(data_hz=data_hz), networks={"LL": tmp_path})
    )
    assert (row.quantity, row.value) == (latency.MET, met)
    assert row.low <= met <= row.high
    assert row.high - row.low < 0.3
    assert "ms" not in (tmp_path / "latency.csv").read_text()
    if met:
        check_golden_table(tmp_path / "latency.csv")


def test_a_sample_has_an_upright_base(layout: JointLayout) -> None:
    sample = latency.random_sample(layout, 0)
    assert sample.q[3:7].tolist() == [1.0, 0.0, 0.0, 0.0]
    assert sample.v.shape == (layout.nv,)
    assert sample.acc_base_in_base.shape == (3,)
