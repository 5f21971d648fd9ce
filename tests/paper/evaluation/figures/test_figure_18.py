"""Figure 18 averages over joints, so that an arm of eight weighs more than a waist of three."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, read_table, write_rows

from experiments.evaluation.compare.rmse import PUSHED
from experiments.evaluation.figures.paper.figure_18 import UPPER_BODY, draw_limbs, figure_18
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import PushWindow
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.rows import read_rows

MEANS = {"MOB-Net": 2.0, "MOB-Net-Single": 2.5}
Write = Callable[..., Path]
Draw = Callable[..., None]


@pytest.fixture
def draw(tmp_path: Path, settings: Settings, evaluation: Evaluation) -> Draw:
    """Return a function of (changes of the section, scores, windows around pushes={}) that writes the figure."""

    def write(
        changes: dict[str, object], scores: list[Path], windows: Mapping[str, PushWindow] = MappingProxyType({})
    ) -> None:
        section = evaluation.figure_18.model_copy(update={"level": "all_uncertainty", **changes})
        figure_18(section, windows, settings.layout, evaluation.statistics, scores, tmp_path / "out")

    return write


@pytest.fixture
def bars(tmp_path: Path, draw: Draw, write_limb_scores: Write) -> list[SimpleNamespace]:
    """The bars of made-up scores."""
    draw({}, [write_limb_scores(name, MEANS) for name in ("motion_test", "hand_wrench")])
    check_golden(tmp_path / "out/figure_18.csv")
    return read_table(tmp_path / "out/figure_18.csv")


def test_every_test_method_limb_and_joint_has_its_bar(bars: list[SimpleNamespace], layout: JointLayout) -> None:
    assert len(bars) == len({(bar.scenario, bar.method, bar.limb, bar.joint) for bar in bars})
    assert len(bars) == 2 * 2 * (1 + 1 + len(layout.limb("W")) + 1 + len(layout.limb("RA")))
    for bar in bars:
        assert bar.rmse_nm == pytest.approx(MEANS[bar.method])
        assert bar.low is not None
        assert bar.high is not None
        assert bar.low < bar.rmse_nm < bar.high
        assert (bar.networks, bar.walks) == (2, 2)


def test_limbs_count_by_their_joints(tmp_path: Path, draw: Draw, write_limb_scores: Write) -> None:
    path = write_limb_scores("motion_test", {"MOB-Net": 1.0}, networks=1)
    rows = read_rows(path, Score)
    waist = [row for row in rows if row.limb == "W"]
    tripled = [Score(**{**vars(row), "value": 3 * row.value}) for row in waist]
    write_rows(path, [row for row in rows if row.limb != "W"] + tripled)
    draw({"methods": ("MOB-Net",), "panels": {"motion_test": "ID"}}, [path])
    found = {(bar.limb, bar.joint): bar.rmse_nm for bar in read_table(tmp_path / "out/figure_18.csv")}
    assert found[UPPER_BODY, "avg"] == pytest.approx((3 * 3.0 + 8 * 1.0) / 11, rel=1e-5)  # six digits stand in the file
    assert found["W", "avg"] == pytest.approx(3.0)


def test_only_the_time_of_pushes_counts_where_there_is_a_window(
    tmp_path: Path, draw: Draw, write_limb_scores: Write, evaluation: Evaluation
) -> None:
    paths = [write_limb_scores(name, MEANS) for name in ("motion_test", "hand_wrench")]
    rows = read_rows(paths[1], Score)
    pushed = [replace(row, metric=PUSHED, value=3.0 * row.value) for row in rows if row.metric == "rmse"]
    write_rows(paths[1], [*rows, *pushed])
    draw({}, paths, evaluation.windows)
    found = {(bar.scenario, bar.method): bar.rmse_nm for bar in read_table(tmp_path / "out/figure_18.csv")}
    assert found["motion_test", "MOB-Net"] == pytest.approx(2.0)
    assert found["hand_wrench", "MOB-Net"] == pytest.approx(6.0)


def test_a_missing_method_is_named(tmp_path: Path, draw: Draw, write_limb_scores: Write) -> None:
    scores = [write_limb_scores(name, {"MOB-Net": 1.0}) for name in ("motion_test", "hand_wrench")]
    with pytest.raises(DataError, match="MOB-Net-Single"):
        draw({}, scores)
    assert not (tmp_path / "out").exists()


def test_bars_have_their_heights_intervals_and_numbers_and_all_limbs_stand_apart() -> None:
    heights = {"a": [1.0, 2.0, 3.0], "b": [3.0, 4.0, 5.0]}
    made: list[tuple[str, str, str, str, float]] = []
    for scenario, (method, own) in product(("motion_test", "hand_wrench"), heights.items()):
        made += [
            (scenario, method, limb, "avg", height) for limb, height in zip((UPPER_BODY, "W", "RA"), own, strict=True)
        ]
        made.append((scenario, method, "W", "W1", 9.0))  # that of a joint is not drawn
    rows = pd.DataFrame(made, columns=["scenario", "method", "limb", "joint", "value"])
    rows = rows.assign(low=rows["value"] - 0.5, high=rows["value"] + 0.25)
    figure = draw_limbs(rows, {"motion_test": "ID", "hand_wrench": "pushed"}, "RMSE [N m]")
    first, second = figure.axes
    assert first.get_ylim() == second.get_ylim()
    assert first.get_ylim()[0] == 0.0
    assert [patch.get_height() for patch in first.patches] == [1.0, 2.0, 3.0, 3.0, 4.0, 5.0]
    assert [text.get_text() for text in first.texts] == ["1.0", "2.0", "3.0", "3.0", "4.0", "5.0"]
    ends = np.concatenate([np.asarray(lines.get_segments())[:, :, 1] for lines in first.collections])
    np.testing.assert_allclose(ends[0], [0.5, 1.25])
    one, two, three = first.get_xticks()
    assert two - one > three - two
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a", "b"]
