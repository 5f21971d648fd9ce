"""Columns of tables are joints, limbs joint by joint, and means over joints of one unit."""

from itertools import product

import pytest

from experiments.evaluation.number.scored import columns_of
from experiments.settings.runs import Mean
from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout


def test_a_limb_is_its_joints_one_by_one(layout: JointLayout) -> None:
    columns = columns_of(layout, ["W", "LL3", "V1"])
    assert list(columns["column"]) == ["W1", "W2", "W3", "LL3", "V1"]
    assert columns.to_numpy().tolist()[3:] == [["LL3", "N m", "LL", "LL3", ""], ["V1", "N", "V", "V1", ""]]


def test_a_mean_is_over_limbs_and_joints_and_perhaps_metrics(layout: JointLayout) -> None:
    metrics = ("rmse_push_1", "rmse_push_2")
    column = columns_of(layout, [Mean(name="avg W+LA1", joints=("W", "LA1"), metrics=metrics)])
    joints = [("W", "W1"), ("W", "W2"), ("W", "W3"), ("LA", "LA1")]
    assert column.to_numpy().tolist() == [
        ["avg W+LA1", "N m", *joint, metric] for joint, metric in product(joints, metrics)
    ]


@pytest.mark.parametrize(
    ("item", "says"),
    [
        (Mean(name="avg V", joints=("V",)), "'avg V': a mean over V1, V2, V3, V4, V5, V6 mixes N and N m"),
        ("LL9", "'LL9' is not accepted"),
        (Mean(name="avg", joints=("tail",)), "'tail' is not accepted"),
    ],
)
def test_what_cannot_be_a_column_is_named(item: str | Mean, says: str, layout: JointLayout) -> None:
    with pytest.raises(ConfigError, match=says):
        columns_of(layout, [item])
