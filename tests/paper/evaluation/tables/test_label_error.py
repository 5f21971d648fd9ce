"""Errors of the foot sensors' labels are taken against the truth, in the swing and on the ground apart."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, markdown_cells, read_table

from experiments.settings.settings import Settings
from mobnet.core.columns import residual_columns
from mobnet.core.joints import JointLayout
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import write_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import read_wrenches
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel


def test_errors_are_those_of_each_label(
    make_table: Callable[..., Path], settings: Settings, layout: JointLayout, data_sets: dict[str, list[Path]],
    tmp_path: Path,
) -> None:  # fmt: skip
    """The truth is made 1 N m less than the better label where the left foot swings, and equal to it elsewhere."""
    recording, residual = data_sets["walk"][0], tmp_path / "residual"
    nominal, read = NominalModel(describe(settings.robot)), read_sensed(recording, layout)
    wrenches = read_wrenches(recording, nominal.robot)
    best, raw = (foot_label(nominal, read, wrenches, settings.observer.gain_hz, plates=on) for on in (True, False))
    air = read.sensed.swing[:, :1] > 0
    write_array(
        residual, np.concatenate([best, best - air], axis=1), residual_columns(layout), {"rate_hz": read.rate_hz}
    )
    table = make_table("label_error", walks={"robot_1": (recording, residual)})
    found = {(row.label, row.phase, row.joint): row.value for row in read_table(table)}
    for joint in (*layout.limb("LL"), "avg"):
        assert found["without the plate", "swing", joint] == pytest.approx(1.0, abs=1e-3)
        assert found["without the plate", "ground", joint] == pytest.approx(0.0, abs=1e-3)
        assert found["without the plate", "walk", joint] == pytest.approx(np.sqrt(air.mean()), abs=1e-3)
    knee = layout.names.index("LL4")
    expected = np.sqrt(np.mean((raw - best + air)[:, knee] ** 2))
    assert found["as read", "walk", "LL4"] == pytest.approx(expected, rel=1e-3)
    assert markdown_cells(table)[3][:2] == ["", "without the plate"]
    assert markdown_cells(table)[3][-2:] == ["1.00", "0.00"]
    check_golden(table)
