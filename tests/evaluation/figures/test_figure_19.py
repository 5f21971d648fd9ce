"""Figure 19 shows samples of the recordings, evenly thinned and the same in every run."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from mobnet.core.errors import DataError
from mobnet.core.store import read_array
from mobnet.evaluation.figures.figure_19 import Cloud, draw_clouds, figure_19, read_dots
from mobnet.evaluation.measure.windows import Pushed
from mobnet.settings.evaluation import Evaluation

Sets = dict[str, list[Path]]


def test_dots_are_samples_in_the_order_of_time(data_sets: Sets) -> None:
    stems = data_sets["walk"]
    dots = read_dots(stems, ["LL3", "LL4"], 100)
    whole = np.concatenate([read_array(stem, ["v.LL3", "tau_des.LL3", "v.LL4", "tau_des.LL4"])[0] for stem in stems])
    assert dots.shape == (100, 2, 2)
    np.testing.assert_array_equal(dots.reshape(100, 4), whole[::40])


def test_a_test_without_pushes_gives_no_dots(data_sets: Sets) -> None:
    assert read_dots(data_sets["test"][:1], ["LL3"], 10, Pushed("LL3", 1e6, 0.1)).shape == (0, 1, 2)


def test_every_set_has_the_dots_asked_for(tmp_path: Path, evaluation: Evaluation, data_sets: Sets) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    figure_19(evaluation.figure_19, evaluation.coverage, training, [data_sets["test"]], tmp_path)
    counts = Counter((row.set, row.joint) for row in read_table(tmp_path / "figure_19.csv"))
    dots = {**dict.fromkeys(training, 12), "walk_test": 8}
    assert counts == {(name, joint): count for name, count in dots.items() for joint in ("LL2", "LL3")}
    check_golden(tmp_path / "figure_19.csv")
    assert (tmp_path / "figure_19.png").read_bytes().startswith(b"\x89PNG")


def test_an_unknown_joint_is_named(data_sets: Sets) -> None:
    with pytest.raises(DataError, match=r"v\.XX1"):
        read_dots(data_sets["walk"][:1], ["XX1"], 5)


def test_each_panel_shows_its_joint_and_set_under_the_test(rng: np.random.Generator) -> None:
    clouds = [
        Cloud(joint, name, rng.normal(size=(5, 2)), rng.normal(size=(3, 2)))
        for name in ("with RTE", "without RTE")
        for joint in ("LL2", "LL3")
    ]
    figure = draw_clouds(clouds, "test")
    assert len(figure.axes) == 4
    for axis, cloud in zip(figure.axes, clouds, strict=True):
        training, test = (collection.get_offsets() for collection in axis.collections)
        np.testing.assert_array_equal(training, cloud.dots)
        np.testing.assert_array_equal(test, cloud.test)
        assert all(collection.get_rasterized() for collection in axis.collections)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["training with RTE", "training without RTE", "test"]
    assert figure.axes[0].get_ylabel() == "desired torque [N m]"
    assert figure.axes[2].get_xlabel() == "velocity [rad/s]"


def test_a_column_has_one_scale() -> None:
    clouds = [Cloud("LL2", name, np.full((2, 2), k), np.zeros((1, 2))) for k, name in enumerate(("a", "b"))]
    one, two = draw_clouds(clouds, "test").axes
    assert one.get_xlim() == two.get_xlim()
    assert one.get_ylim() == two.get_ylim()
