"""A network that errs more than it says is flagged by its free swings, whatever happens in stance."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.measure.estimates.changed import FLAGGED, FREE, KNOWN, knowledge
from experiments.plan.runs import Run
from experiments.settings.evaluation import Evaluation

JOINTS = ("LL1", "LL2", "LL3")
RATE_HZ, ROWS, SHARE = 100.0, 4000, 0.68


def measured(evaluation: Evaluation, ratio: float, end: int = ROWS) -> dict[str, np.ndarray]:
    """Return what is told of estimates whose errors are a factor larger than their deviations, up to a row."""
    rng, std = np.random.default_rng(1), np.full((ROWS, len(JOINTS)), 0.5, dtype=np.float32)
    air = np.arange(ROWS) % 140 < 70
    truth = np.where(air, 0.0, 200.0)[:, None] * np.ones(len(JOINTS))
    run = Run("changed_walk", "robots", "MOB-Net", 1, 1, Path("a"), Path("b"), Path("c"))
    estimate = truth + ratio * std * rng.normal(size=std.shape)
    pair = Pair(run, JOINTS, estimate.astype(np.float32), truth.astype(np.float32), ((0, end),), RATE_HZ)
    scene: Any = SimpleNamespace(planned=lambda _: air)
    return {name: values for name, values, *_ in knowledge(pair, std, scene, SHARE, evaluation.changed)}


@pytest.mark.parametrize(("ratio", "share", "flagged"), [(1.0, 0.68, 0.0), (3.0, 0.26, 1.0)])
def test_free_swings_tell_what_only_the_truth_tells_of_the_whole(
    evaluation: Evaluation, ratio: float, share: float, flagged: float
) -> None:
    found = measured(evaluation, ratio)
    assert found[KNOWN] == pytest.approx(np.full(3, share), abs=0.03)
    assert found[FREE] == pytest.approx(np.full(3, share), abs=0.03)
    assert found[FLAGGED] == pytest.approx(np.full(3, flagged))


def test_a_walk_shorter_than_a_window_has_no_windows(evaluation: Evaluation) -> None:
    assert list(measured(evaluation, 1.0, end=900)) == [KNOWN]
