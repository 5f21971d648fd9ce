"""What every estimator must keep to, whatever it is made of; a test runs each check on each method."""

import typing
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.estimator import Stretch, TorqueEstimator, estimate_all
from mobnet.core.recording import Sensed

RELATIVE = 1e-5


def stepped(estimator: TorqueEstimator, sensed: Sensed) -> tuple[NDArray[Any], NDArray[Any] | None]:
    """Return what stepping through a recording gives, (T, n) each [N, N m]."""
    state, rows = estimator.init(), []
    for k in range(len(sensed)):
        state, one = estimator.step(state, sensed[k])
        rows.append(one)
    stds = [row.std for row in rows if row.std is not None]
    return np.stack([row.tau_ext for row in rows]), np.stack(stds) if stds else None


def step_equals_estimate(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """Sample by sample and all at once are equivalent."""
    whole = estimator.estimate(sensed)
    tau, std = stepped(estimator, sensed)
    np.testing.assert_allclose(tau, whole.tau_ext, rtol=0, atol=RELATIVE * np.abs(whole.tau_ext).max())
    assert (std is None) == (whole.std is None)
    if std is not None and whole.std is not None:
        np.testing.assert_allclose(std, whole.std, rtol=RELATIVE)


def with_another_end(estimator: TorqueEstimator, sensed: Sensed) -> tuple[NDArray[Any], NDArray[Any], int]:
    """Return the estimates (T, n) of a recording and of one that differs from some sample on, and that sample."""
    cut, changed = len(sensed) // 2, {}
    for field in fields(Sensed):
        values = np.array(getattr(sensed, field.name))
        values[cut:] = values[:1]
        changed[field.name] = values
    before, after = (estimator.estimate(s).tau_ext for s in (sensed, replace(sensed, **changed)))
    return before, after, cut


def the_future_does_not_matter(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """An estimate is invariant to samples that come after it."""
    before, after, cut = with_another_end(estimator, sensed)
    np.testing.assert_allclose(before[:cut], after[:cut], rtol=0, atol=RELATIVE * np.abs(before).max())


def side_by_side_is_one_after_the_other(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """Recordings of different lengths together give what each gives alone."""
    stretches = [Stretch(sensed), Stretch(sensed[len(sensed) // 3 :]), Stretch(sensed[:20])]
    for stretch, result in zip(stretches, estimate_all(estimator, stretches), strict=True):
        alone = estimator.estimate(stretch.sensed)
        np.testing.assert_allclose(result.tau_ext, alone.tau_ext, rtol=0, atol=RELATIVE * np.abs(alone.tau_ext).max())
        assert (alone.std is None) == (result.std is None)
        if alone.std is not None and result.std is not None:
            np.testing.assert_allclose(result.std, alone.std, rtol=RELATIVE)


def the_past_matters(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """An estimate depends on what was sensed up to then: true of all but the zero predictor."""
    before, after, cut = with_another_end(estimator, sensed)
    assert np.abs(before[cut:] - after[cut:]).max() > RELATIVE * np.abs(before).max()


def it_reads_no_truth(estimator: TorqueEstimator, _: Sensed) -> None:
    """Its signatures accept what a robot senses, and nothing else."""
    assert typing.get_type_hints(type(estimator).estimate)["sensed"] is Sensed
    assert typing.get_type_hints(type(estimator).step)["sample"] is Sensed


def shapes_are_those_of_its_joints(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """One finite value a sample and joint, no joint twice."""
    result = estimator.estimate(sensed)
    assert result.tau_ext.shape == (len(sensed), len(estimator.joints))
    assert np.isfinite(result.tau_ext).all()
    assert len(set(estimator.joints)) == len(estimator.joints) > 0


def std_is_positive(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """A standard deviation, where there is one, has the estimate's shape and is above zero."""
    result = estimator.estimate(sensed)
    if result.std is not None:
        assert result.std.shape == result.tau_ext.shape
        assert (result.std > 0).all()


def twice_gives_the_same(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """No state hides in the estimator."""
    first, second = estimator.estimate(sensed), estimator.estimate(sensed)
    np.testing.assert_array_equal(first.tau_ext, second.tau_ext)
    state = estimator.init()
    for k in range(3):
        after = estimator.step(state, sensed[k])
        np.testing.assert_array_equal(after[1].tau_ext, estimator.step(state, sensed[k])[1].tau_ext)
        state = after[0]


def recorded_arrays_are_left_alone(estimator: TorqueEstimator, sensed: Sensed) -> None:
    """What was sensed is read, never written."""
    before = [np.array(getattr(sensed, field.name)) for field in fields(Sensed)]
    estimator.estimate(sensed)
    estimator.step(estimator.init(), sensed[0])
    for field, array in zip(fields(Sensed), before, strict=True):
        np.testing.assert_array_equal(getattr(sensed, field.name), array)


CHECKS = (
    step_equals_estimate,
    side_by_side_is_one_after_the_other,
    the_future_does_not_matter,
    the_past_matters,
    it_reads_no_truth,
    shapes_are_those_of_its_joints,
    std_is_positive,
    twice_gives_the_same,
    recorded_arrays_are_left_alone,
)
