"""Figure 19 shows samples of the recordings, evenly thinned and the same in every run."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from mobnet.core.columns import FEET
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.evaluation.compare.windows import Pushed, evenly
from mobnet.evaluation.figures.paper.figure_19 import Cloud, draw_clouds, figure_19, range_of, read_dots
from mobnet.evaluation.measure.data.conditional import gait_phase
from mobnet.settings.evaluation import Coverage, Evaluation

Sets = dict[str, list[Path]]


def test_dots_are_samples_in_the_order_of_time(data_sets: Sets) -> None:
    stems = data_sets["walk"]
    dots = read_dots(stems, ["LL3", "LL4"], 100, FEET[0])
    names = ["swing.left_foot", "v.LL3", "tau_des.LL3", "v.LL4", "tau_des.LL4"]
    read = [read_array(stem, names) for stem in stems]
    phase = np.concatenate([gait_phase(array[:, 0] > 0.5, note["segments"]) for array, note in read])
    known = np.isfinite(phase)
    whole = np.concatenate([array for array, _ in read])[known][:, 1:].reshape(-1, 2, 2)
    assert dots.shape == (100, 2, 3)
    picked = evenly(int(known.sum()), 100)
    np.testing.assert_array_equal(dots[..., :2], whole[picked])
    np.testing.assert_array_equal(dots[:, 0, 2], phase[known][picked].astype(np.float32))


def test_a_test_without_pushes_gives_no_dots(data_sets: Sets) -> None:
    assert read_dots(data_sets["test"][:1], ["LL3"], 10, FEET[0], Pushed("LL3", 1e6, 0.1)).shape == (0, 1, 3)


def test_every_set_has_the_dots_asked_for(
    tmp_path: Path, evaluation: Evaluation, layout: JointLayout, data_sets: Sets
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    figure_19(evaluation.figure_19, evaluation.coverage, layout, training, [data_sets["test"]], tmp_path)
    counts = Counter((row.set, row.joint) for row in read_table(tmp_path / "figure_19.csv"))
    dots = {**dict.fromkeys(training, 12), "walk_test": 8}
    assert counts == {(name, joint): count for name, count in dots.items() for joint in ("LL2", "LL3")}
    check_golden(tmp_path / "figure_19.csv")
    assert (tmp_path / "figure_19.png").read_bytes().startswith(b"\x89PNG")


def test_an_unknown_joint_is_named(data_sets: Sets) -> None:
    with pytest.raises(DataError, match=r"v\.XX1"):
        read_dots(data_sets["walk"][:1], ["XX1"], 5, FEET[0])


def cloud(joint: str, training: str, dots: np.ndarray, test: np.ndarray, coverage: Coverage) -> Cloud:
    return Cloud(joint, training, dots, test, range_of(dots, coverage))


def test_each_panel_shows_its_joint_and_set_under_the_test(rng: np.random.Generator, evaluation: Evaluation) -> None:
    clouds = [
        cloud(joint, name, rng.uniform(size=(50, 3)), rng.uniform(size=(3, 3)), evaluation.coverage)
        for name in ("with RTE", "without RTE")
        for joint in ("LL2", "LL3")
    ]
    figure = draw_clouds(clouds, "test")
    assert len(figure.axes) == 6
    for axis, one in zip(figure.axes, clouds, strict=False):
        training, test = (collection.get_offsets() for collection in axis.collections)
        np.testing.assert_array_equal(training, one.dots[:, :2])
        np.testing.assert_array_equal(test, one.test[:, :2])
        assert all(collection.get_rasterized() for collection in axis.collections)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["training with RTE", "training without RTE", "test"]
    assert figure.axes[0].get_ylabel() == "desired torque [N m]"
    assert figure.axes[2].get_xlabel() == "velocity [rad/s]"


def test_the_last_row_shades_the_range_by_phase_of_every_set(rng: np.random.Generator, evaluation: Evaluation) -> None:
    dots = {name: rng.uniform(size=(400, 3)) * [1.0, size, 1.0] for name, size in (("a", 10.0), ("b", 4.0))}
    clouds = [cloud("LL2", name, one, np.full((2, 3), 0.25), evaluation.coverage) for name, one in dots.items()]
    last = draw_clouds(clouds, "test").axes[-1]
    for patch, one in zip(last.patches, clouds, strict=True):
        values, edges, baseline = patch.get_data()
        np.testing.assert_array_equal(values, one.range.high)
        np.testing.assert_array_equal(baseline, one.range.low)
        assert len(edges) == evaluation.coverage.phases + 1
    assert (clouds[0].range.high > 9.0).all()
    assert (clouds[1].range.high < 4.0).all()
    (test,) = last.collections
    np.testing.assert_array_equal(test.get_offsets(), [[0.25, 0.25]] * 2)


def test_a_column_has_one_scale(evaluation: Evaluation) -> None:
    clouds = [
        cloud("LL2", name, np.full((2, 3), k), np.zeros((1, 3)), evaluation.coverage) for k, name in enumerate("ab")
    ]
    one, two, phases = draw_clouds(clouds, "test").axes
    assert one.get_xlim() == two.get_xlim() != phases.get_xlim()
    assert one.get_ylim() == two.get_ylim() == phases.get_ylim()
