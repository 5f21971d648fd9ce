"""Contiguous streams: a 9:1 split in blocks, and lanes whose state can be carried."""

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.learning.streams import cut_streams, deal, epoch_plan, some_of, split, validation_plan, window_plan

SEGMENTS = [(0, 10_000), (10_000, 13_337), (13_337, 13_360), (13_360, 20_000)]
STREAM, HORIZON, LANES = 1000, 50, 8


def test_split_is_9_to_1_in_blocks_and_loses_nothing():
    training, validation = split(SEGMENTS, 0.1)
    covered = np.concatenate([np.arange(a, b) for a, b in sorted(training + validation)])
    np.testing.assert_array_equal(covered, np.arange(20_000))
    assert sum(b - a for a, b in validation) == pytest.approx(2000, abs=len(SEGMENTS))
    assert len(validation) == len(SEGMENTS)


def test_recordings_that_are_held_out_validate_whole():
    first = SEGMENTS[-1][0]
    assert split(SEGMENTS, 0.1, first) == (list(SEGMENTS[:-1]), [SEGMENTS[-1]])


def test_no_training_row_is_seen_twice_in_an_epoch_and_few_are_left_out():
    training, _ = split(SEGMENTS, 0.1)
    plan = epoch_plan(training, STREAM, HORIZON, LANES, np.random.default_rng(0))
    rows = (plan.rows[..., None] + np.arange(HORIZON)).ravel()
    allowed = np.concatenate([np.arange(a, b) for a, b in training])
    assert len(np.unique(rows)) == len(rows)
    assert np.isin(rows, allowed).all()
    assert len(rows) > 0.9 * len(allowed)


def test_state_is_carried_only_from_one_sample_to_the_next():
    plan = epoch_plan(SEGMENTS, STREAM, HORIZON, LANES, np.random.default_rng(1))
    follows = np.diff(plan.rows, axis=0) == HORIZON
    assert plan.fresh[0].all()
    assert follows[~plan.fresh[1:]].all()
    assert plan.fresh.mean() < 3 * HORIZON / STREAM


def test_a_state_never_crosses_a_segment():
    plan = epoch_plan(SEGMENTS, STREAM, HORIZON, LANES, np.random.default_rng(2))
    segment = np.searchsorted([start for start, _ in SEGMENTS], plan.rows, side="right")
    last = np.searchsorted([start for start, _ in SEGMENTS], plan.rows + HORIZON - 1, side="right")
    np.testing.assert_array_equal(segment, last)
    assert plan.fresh[1:][np.diff(segment, axis=0) != 0].all()


def test_epochs_differ_and_repeat_with_their_seed():
    plans = [epoch_plan(SEGMENTS, STREAM, HORIZON, LANES, np.random.default_rng(seed)) for seed in (1, 1, 2)]
    np.testing.assert_array_equal(plans[0].rows, plans[1].rows)
    assert not np.array_equal(plans[0].rows[:10], plans[2].rows[:10])
    assert set(np.unique(plans[0].rows % HORIZON)) != set(np.unique(plans[2].rows % HORIZON))


def test_validation_carries_the_state_through_a_whole_block():
    plan = validation_plan([(100, 1105)], 10_000, HORIZON, LANES)
    np.testing.assert_array_equal(plan.rows[:, 0], np.arange(100, 1100, HORIZON))
    assert plan.fresh.sum() == 1


def test_pieces_shorter_than_a_horizon_are_left_out():
    assert cut_streams([(0, 49), (60, 175)], STREAM, HORIZON) == [(60, 160)]


def test_too_few_samples_for_a_batch_are_refused():
    with pytest.raises(DataError, match="2 horizons of 50 samples cannot fill a batch of 8"):
        deal([(0, 100)], LANES, HORIZON)
    with pytest.raises(DataError, match="0 horizons"):
        deal([], LANES, HORIZON)


def test_windows_lie_whole_inside_blocks_and_start_from_zero():
    blocks = [(0, 30), (40, 45), (50, 65)]
    plan = window_plan(blocks, 100, 10, 4, np.random.default_rng(0), samples=4000)
    assert plan.rows.shape == (100, 4)
    assert plan.fresh.all()
    assert set(plan.rows.ravel()) == {*range(21), *range(50, 56)}


def test_windows_of_an_epoch_have_as_many_samples_as_the_blocks():
    assert len(window_plan([(0, 95)], 100, 10, 3, np.random.default_rng(0))) == 3


def test_too_few_samples_for_a_batch_of_windows_are_refused():
    with pytest.raises(DataError, match="11 windows of 10 samples cannot fill a batch of 4"):
        window_plan([(0, 20)], 100, 10, 4, np.random.default_rng(0))


def test_blocks_that_hold_no_window_are_refused_however_many_samples_are_asked_for():
    with pytest.raises(DataError, match="0 windows of 10 samples cannot fill a batch of 4"):
        window_plan([(0, 5)], 100, 10, 4, np.random.default_rng(0), samples=4000)
    for blocks in ([], [(5, 5)]):  # of which a share of a short segment is none
        with pytest.raises(DataError, match="0 horizons"):
            validation_plan(blocks, STREAM, HORIZON, LANES)


@pytest.mark.parametrize(("rows", "lanes"), [(100_000, LANES), (3100, 3), (900, 1)])
def test_validation_has_a_lane_for_each_stream_at_least_one_and_at_most_all(rows, lanes):
    assert validation_plan([(0, rows)], STREAM, HORIZON, LANES).rows.shape[1] == lanes


def test_a_part_of_the_data_is_whole_streams_at_least_one_and_ends_with_its_block():
    blocks, rng = [(0, 2500), (4000, 4300)], np.random.default_rng(0)
    streams = {(0, 1000), (1000, 2000), (2000, 2500), (4000, 4300)}
    assert some_of(blocks, STREAM, 1, rng) == blocks
    seen = set()
    for _ in range(30):
        half = some_of(blocks, STREAM, 2, rng)
        assert (len(half), half) == (2, sorted(half))
        assert len(some_of(blocks, STREAM, 100, rng)) == 1
        seen |= set(half)
    assert seen == streams
