"""Figure 19 shows torques by phase, and the file how the samples of training sets and tests lie in the plane."""

from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table
from numpy.typing import NDArray

from experiments.evaluation.compare.windows import Pushed, evenly
from experiments.evaluation.figures.paper.figure_19 import draw_ranges, figure_19
from experiments.evaluation.measure.data.conditional import gait_phase
from experiments.evaluation.measure.data.planes import TESTS, Plane, plane_of, read_samples
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import Coverage
from mobnet.core.columns import FEET
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array

Sets = dict[str, list[Path]]


def test_samples_are_in_the_order_of_time_where_the_phase_is_known(data_sets: Sets) -> None:
    stems = data_sets["walk"]
    samples = read_samples(stems, ["LL3", "LL4"], 100, FEET[0])
    names = ["swing.left_foot", "v.LL3", "tau_des.LL3", "v.LL4", "tau_des.LL4"]
    read = [read_array(stem, names) for stem in stems]
    phase = np.concatenate([gait_phase(array[:, 0] > 0.5, note["segments"]) for array, note in read])
    known = np.isfinite(phase)
    whole = np.concatenate([array for array, _ in read])[known][:, 1:].reshape(-1, 2, 2)
    assert samples.shape == (100, 2, 3)
    picked = evenly(int(known.sum()), 100)
    np.testing.assert_array_equal(samples[..., :2], whole[picked])
    np.testing.assert_array_equal(samples[:, 0, 2], phase[known][picked].astype(np.float32))


def test_a_test_without_pushes_gives_no_samples(data_sets: Sets) -> None:
    assert read_samples(data_sets["test"][:1], ["LL3"], 10, FEET[0], Pushed("LL3", 1e6, 0.1)).shape == (0, 1, 3)


def test_an_unknown_joint_is_named(data_sets: Sets) -> None:
    with pytest.raises(DataError, match=r"v\.XX1"):
        read_samples(data_sets["walk"][:1], ["XX1"], 5, FEET[0])


def test_the_file_has_the_cells_of_every_set_and_joint_and_the_ranges_by_phase(
    tmp_path: Path, evaluation: Evaluation, layout: JointLayout, data_sets: Sets
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    figure_19(evaluation.figure_19, evaluation.coverage, layout, training, [data_sets["test"]], tmp_path)
    rows = read_table(tmp_path / "figure_19.csv")
    shares = {(row.set, row.joint): 0.0 for row in rows if row.kind == "plane"}
    assert set(shares) == {(name, joint) for name in (*training, TESTS) for joint in ("LL2", "LL3")}
    for row in (row for row in rows if row.kind == "plane"):
        shares[row.set, row.joint] += row.share_percent
    assert all(90.0 < share <= 100.0 + 1e-3 for (name, _), share in shares.items() if name != TESTS)
    check_golden(tmp_path / "figure_19.csv")
    assert (tmp_path / "figure_19.png").read_bytes().startswith(b"\x89PNG")


def made(rng: np.random.Generator, shift: float, count: int = 4000) -> NDArray[np.float64]:
    """Return samples of normal velocities and torques around a velocity [rad/s], at even phases."""
    return np.stack([rng.normal(shift, 1.0, count), rng.normal(0.0, 10.0, count), rng.uniform(size=count)], axis=1)


def plane(rng: np.random.Generator, coverage: Coverage, shift: float) -> Plane:
    """Return the plane of two sets, the second one shifted, and of tests like the first."""
    sets = {"with RTE": made(rng, 0.0), "without RTE": made(rng, shift), TESTS: made(rng, 0.0, 500)}
    return plane_of("LL2", sets, coverage)


def test_sets_that_are_alike_have_all_in_common_and_sets_apart_have_nothing(evaluation: Evaluation) -> None:
    coverage = evaluation.coverage.model_copy(update={"cell_range": (0.0, 1.0)})
    alike, apart = (plane(np.random.default_rng(1), coverage, shift) for shift in (0.0, 50.0))
    assert alike.common > 80.0
    assert apart.common == 0.0


def test_a_panel_shows_the_ranges_by_phase_and_what_the_sets_have_in_common(
    rng: np.random.Generator, evaluation: Evaluation
) -> None:
    one = plane(rng, evaluation.coverage, 0.5)
    figure = draw_ranges([one, one])
    first, second = figure.axes
    filled, *outlines = first.patches
    values, edges, baseline = filled.get_data()  # type: ignore[attr-defined]
    np.testing.assert_array_equal(values, one.ranges["with RTE"].high)
    np.testing.assert_array_equal(baseline, one.ranges["with RTE"].low)
    assert len(edges) == evaluation.coverage.phases + 1
    assert len(outlines) == 2 * 3
    assert len({str(patch.get_linestyle()) for patch in outlines}) == 3  # sets differ without colour, too
    assert f"{one.common:.0f} % of samples in common" in [text.get_text() for text in first.texts]
    assert first.get_ylim()[0] < np.nanmin(one.ranges["with RTE"].low)
    assert (first.get_ylabel(), second.get_ylabel()) == ("desired torque [N m]", "")
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["training with RTE", "training without RTE", "tests"]


def test_a_training_set_without_samples_has_no_share_in_any_cell(evaluation: Evaluation) -> None:
    """Its shares are zero and not 0/0."""
    some = np.random.default_rng(0).normal(size=(100, 3)).astype(np.float32)
    some[:, 2] = np.linspace(0.0, 0.99, 100)
    plane = plane_of("LL3", {"with": some, "without": some[:0]}, evaluation.coverage)
    assert plane.shares["without"].tolist() == np.zeros(plane.shares["with"].shape).tolist()
    assert plane.shares["with"].sum() > 90.0
    assert plane.common == 0.0
