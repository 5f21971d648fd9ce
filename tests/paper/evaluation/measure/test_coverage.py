"""Coverage is 1 : 1 where both sets are alike, and sees the set that is wider."""

from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.measure.data.coverage import (
    ALL,
    AREA,
    BEYOND,
    NEAREST,
    OUTSIDE,
    WIDTH,
    beyond,
    conditional,
    covered,
    nearest,
    outside,
    training_rows,
    visited,
    widths,
    with_interval,
    without_part,
)
from experiments.evaluation.measure.data.samples import equal_sets, read_blocks, refer, scale_of
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import CoverageTest
from experiments.settings.settings import Settings
from mobnet.core.joints import JointLayout
from mobnet.learning.features import limb_inputs

Sets = dict[str, list[Path]]
NAMES = ("v.LL1", "tau_des.LL1")
DRAWS = 40
TEST = CoverageTest(scenario="walk_test", level="all_uncertainty")


def test_an_inner_test_is_inside_and_a_far_one_outside(rng: np.random.Generator) -> None:
    training = rng.uniform(-1, 1, (4000, 2))
    references = [refer(factor * training, [0.01, 0.99], np.zeros(2), np.ones(2)) for factor in (1.0, 0.1)]
    rows = {
        (row["measure"], row["joint"]): row for row in outside(TEST, [0.5 * training[:500]], references, NAMES, ["LL1"])
    }
    for measure in OUTSIDE.values():
        assert rows[measure, "LL1"]["with_rte"] == 0.0
        assert rows[measure, "LL1"]["without_rte"] == pytest.approx(0.8, abs=0.05)
        assert rows[measure, ALL]["without_rte"] == rows[measure, "LL1"]["without_rte"]


def test_about_two_percent_of_training_lie_outside_its_own_range(rng: np.random.Generator) -> None:
    training = rng.normal(size=(5000, 2))
    reference = refer(training, [0.01, 0.99], np.zeros(2), np.ones(2))
    for row in outside(TEST, [training], [reference, reference], NAMES, ["LL1"]):
        assert row["with_rte"] == pytest.approx(0.02, abs=0.001)


def test_distance_to_the_nearest_sample_has_its_closed_form_in_units_of_the_common_spread(
    evaluation: Evaluation,
) -> None:
    mean, std = np.array([1.0, 2.0]), np.array([2.0, 4.0])
    references = [
        refer(np.array([[1.0, 2.0], [9.0, 2.0]]), [0, 1], mean, std),
        refer(np.array([[1.0, 6.0]] * 2), [0, 1], mean, std),
    ]
    block = (np.array([[5.0, 2.0], [1.0, 2.0], [3.0, 2.0]]) - mean) / std  # 2, 0 and 1 away from the first set
    rows = list(nearest(TEST, [block, block], references, evaluation.statistics))
    assert [row["measure"] for row in rows] == list(NEAREST)
    assert rows[0]["with_rte"] == pytest.approx(1.0)
    assert rows[0]["without_rte"] == pytest.approx(np.sqrt(2.0))
    assert [rows[0][name] for name in ("ratio", "low", "high")] == pytest.approx([np.sqrt(0.5)] * 3)


def test_the_wider_set_visits_more_of_the_plane_and_equal_sets_equally_much(
    rng: np.random.Generator, evaluation: Evaluation
) -> None:
    wide, plane = rng.uniform(-1, 1, (3000, 2)), evaluation.coverage.model_copy(update={"cell_range": (0.0, 1.0)})
    assert {row["ratio"] for row in visited(AREA, [wide, wide], NAMES, ["LL1"], plane)} == {1.0}
    for row in visited(AREA, [wide, 0.5 * wide], NAMES, ["LL1"], plane):
        assert row["measure"] == AREA
        assert row["with_rte"] == pytest.approx(1.0, abs=0.02)
        assert row["ratio"] == pytest.approx(4.0, rel=0.5)


def test_intervals_over_stretches_of_the_walks_hold_the_ratio_of_two_walks_without_end(
    rng: np.random.Generator, evaluation: Evaluation
) -> None:
    """Simulated: the torque of a stretch is scaled as one draws, and in one set by a fifth more."""
    coverage = evaluation.coverage.model_copy(update={"phases": 2, "state_cells": 2})
    names = ("q.LL1", "v.LL1", "tau_des.LL1", "phase")
    held = 0
    for _ in range(DRAWS):
        sets = [walk_of(rng, factor) for factor in (1.2, 1.0)]
        left_out = []
        for part in range(coverage.parts):
            kept = without_part(sets, part, coverage.parts)
            assert sum(map(len, kept)) == pytest.approx(0.9 * sum(map(len, sets)))
            left_out.append(training_rows(kept, kept, names, ["LL1"], coverage))
        rows = [with_interval(row, left_out, evaluation.statistics) for row in
                training_rows(sets, sets, names, ["LL1"], coverage)]  # fmt: skip
        (row,) = (row for row in rows if (row["measure"], row["joint"]) == (WIDTH["phase"], ALL))
        assert row["low"] is not None
        assert row["high"] is not None
        held += row["low"] <= 1.2 <= row["high"]
    assert held >= 0.88 * DRAWS


def walk_of(rng: np.random.Generator, factor: float) -> np.ndarray:
    """Return samples (1000, 4) of twenty stretches: position, velocity, torque and phase."""
    size = np.repeat(np.exp(0.2 * rng.normal(size=20)), 50)
    torque = factor * size * rng.normal(size=1000)
    return np.column_stack([rng.uniform(-1, 1, (1000, 2)), torque, rng.uniform(0, 1, 1000)])


def test_a_set_that_a_stretch_leaves_without_a_range_has_no_interval(
    rng: np.random.Generator, evaluation: Evaluation
) -> None:
    names = ("q.LL1", "v.LL1", "tau_des.LL1", "phase")
    sets = [walk_of(rng, 1.0) for _ in range(2)]
    (row, *_) = training_rows(sets, sets, names, ["LL1"], evaluation.coverage)
    assert with_interval(row, [[], [row]], evaluation.statistics) == row


def test_sets_are_made_equally_long_and_a_constant_input_keeps_its_scale() -> None:
    sets = [[np.ones((30, 2)), np.zeros((30, 2))], [np.ones((40, 2))]]
    assert [len(samples) for samples in equal_sets(sets, 50)] == [40, 40]
    assert [len(samples) for samples in equal_sets(sets, 10)] == [10, 10]
    assert equal_sets(sets, 10)[0].mean() == 0.5
    np.testing.assert_array_equal(scale_of(np.ones((5, 2)))[1], [1.0, 1.0])


def test_blocks_hold_the_inputs_of_table_1(
    settings: Settings, evaluation: Evaluation, layout: JointLayout, data_sets: Sets
) -> None:
    """Of 20 s in two segments: blocks of 5 s, every second sample; the phase of the gait comes last."""
    inputs = limb_inputs(layout, settings.robot.networks["LL"])
    blocks = read_blocks(data_sets["walk"][:1], layout, inputs, evaluation.coverage)
    assert [block.shape for block in blocks] == [(250, 31)] * 4
    assert (np.nanmin(blocks[1][:, -1]), np.nanmax(blocks[1][:, -1])) == pytest.approx((0.0, 1.0), abs=0.02)


def test_equivalent_sets_come_out_even_and_tests_without_pushes_are_left_out(
    settings: Settings, evaluation: Evaluation, layout: JointLayout, data_sets: Sets
) -> None:
    pushed = CoverageTest(scenario="knee_swing", level="all_uncertainty", pushed="LL3")
    coverage = evaluation.coverage.model_copy(update={"tests": (TEST, pushed)})
    ports, walk, tests = settings.robot.networks["LL"], data_sets["walk"], [data_sets["test"], []]
    rows = covered(coverage, layout, ports, evaluation.statistics, walk, walk, tests)
    assert set(rows["scenario"]) == {"training", "walk_test"}
    assert (rows["with_rte"] == rows["without_rte"]).all()
    assert (rows[rows["measure"].isin([*NEAREST, AREA])]["ratio"] == 1.0).all()


def test_torques_at_their_phase_are_outside_where_pooled_ones_are_inside(
    rng: np.random.Generator, evaluation: Evaluation
) -> None:
    """In training the torque follows the phase, with and without exploration; the test has it half a gait later."""
    phase, names = rng.uniform(0, 1, (4000, 1)), ("q.LL1", "v.LL1", "tau_des.LL1", "phase")
    state = rng.uniform(-1, 1, (4000, 2))
    wide = np.concatenate([state, 10 * phase + rng.normal(0, 2, phase.shape), phase], axis=1)
    narrow = np.concatenate([state, 10 * phase + rng.normal(0, 1, phase.shape), phase], axis=1)
    ranges = conditional([wide, narrow], names, ["LL1"], evaluation.coverage.model_copy(update={"phases": 20}))
    width = {(row["measure"], row["joint"]): row for row in widths(ranges)}
    assert width[WIDTH["phase"], "LL1"]["ratio"] == pytest.approx(2.0, rel=0.1)
    assert width[WIDTH["phase"], ALL]["with_rte"] == width[WIDTH["phase"], "LL1"]["with_rte"]
    assert width[WIDTH["position and velocity"], "LL1"]["with_rte"] > 10.0
    late = np.column_stack([narrow[:, :3], (narrow[:, 3] + 0.5) % 1.0])
    found = {(row["measure"], row["joint"]): row for row in beyond(TEST, [late], ranges, names)}
    assert found[BEYOND["phase"], "LL1"]["without_rte"] > 0.95
    assert 0.5 < found[BEYOND["phase"], "LL1"]["with_rte"] < found[BEYOND["phase"], "LL1"]["without_rte"]
    assert found[BEYOND["position and velocity"], ALL]["without_rte"] < 0.05
    unknown = np.column_stack([narrow[:, :3], np.full(len(narrow), np.nan)])
    assert {row["measure"] for row in beyond(TEST, [unknown], ranges, names)} == {BEYOND["position and velocity"]}
