"""Ranges of a torque under conditions see what ranges of all samples together do not."""

import numpy as np
import pytest

from experiments.evaluation.measure.data.conditional import Cells, even_cells, gait_phase, torque_range


def test_samples_fall_into_the_cells_between_their_edges() -> None:
    cells = Cells((np.array([0.0, 1.0, 2.0]), np.array([-1.0, 0.0, 1.0, 2.0])))
    assert cells.count == 6
    conditions = np.array([[0.0, -1.0], [0.5, 0.5], [1.0, -0.5], [2.0, 2.0], [2.1, 0.0], [0.5, -1.1], [np.nan, 0.0]])
    assert cells.of(conditions).tolist() == [0, 1, 3, 5, -1, -1, -1]
    even = even_cells([(0.0, 2.0), (-1.0, 2.0)], [2, 3])
    assert all((a == b).all() for a, b in zip(even.edges, cells.edges, strict=True))


def test_a_torque_that_occurs_at_another_phase_only_is_outside(rng: np.random.Generator) -> None:
    """Each phase has a torque of its own; pooled, all of them are inside."""
    phase = rng.uniform(0, 1, 20_000)
    torque = 100.0 * phase + rng.normal(size=len(phase))
    known = torque_range(even_cells([(0.0, 1.0)], [20]), phase[:, None], torque, [0.01, 0.99], 50)
    assert known.outside(phase[:, None], torque).mean() == pytest.approx(0.02, abs=0.003)
    assert known.outside(1.0 - phase[:, None], torque).mean() > 0.9
    assert known.width == pytest.approx(5.0 * 0.98 + 2 * 1.5, rel=0.2)


def test_a_cell_that_training_never_visits_has_no_range(rng: np.random.Generator) -> None:
    state = np.concatenate([rng.uniform(0, 1, (5000, 2)), [[1.5, 1.5]] * 49])
    known = torque_range(even_cells([(0.0, 2.0)] * 2, [2, 2]), state, np.ones(len(state)), [0.0, 1.0], 50)
    assert np.isfinite(known.low).tolist() == [True, False, False, False]
    assert known.outside(np.array([[0.5, 0.5], [1.5, 1.5], [5.0, 0.5]]), np.ones(3)).tolist() == [False, True, True]
    empty = torque_range(known.cells, state, np.ones(len(state)), [0.0, 1.0], 10_000)
    assert np.isnan(empty.width)
    assert empty.outside(state, np.ones(len(state))).all()


def test_phase_grows_from_lift_off_over_touch_down_and_is_unknown_at_ends_of_segments() -> None:
    air = np.array([0, 1, 1, 1, 1, 0, 0, 1, 0, 0, 0, 1], dtype=bool)
    phase = gait_phase(air, ((0, 12),))
    np.testing.assert_allclose(phase[1:11], [0, 0.125, 0.25, 0.375, 0.5, 0.75, 0, 0.5, 2 / 3, 5 / 6])
    assert np.isnan(phase[[0, 11]]).all()
    cut = gait_phase(air, ((0, 3), (3, 12)))
    assert np.isnan(cut[:5]).all()
    np.testing.assert_allclose(cut[5:11], phase[5:11])
