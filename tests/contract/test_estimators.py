"""One contract for every row of the configuration's methods."""

from __future__ import annotations

import typing
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray

from mobnet.core.estimator import Estimator
from mobnet.core.recording import Recording, Sensed
from mobnet.estimation.methods import build_estimator

METHODS = list(yaml.safe_load((Path(__file__).parents[2] / "configs" / "config.yaml").read_text())["methods"])
LEVEL, RATE_HZ, SECONDS = "all_uncertainty", 1000.0, 0.6
RELATIVE = 1e-5

Folders = Callable[..., Mapping[str, Path]]


@pytest.fixture(scope="module", params=METHODS)
def method(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def estimator(method: str, full_config: dict[str, Any], network_dirs: Folders) -> Estimator:
    return build_estimator(full_config, method, network_dirs(method), LEVEL, RATE_HZ)


@pytest.fixture(scope="module")
def sensed(made_up: Callable[..., Recording]) -> Sensed:
    return made_up(5, SECONDS).sensed


def stepped(estimator: Estimator, sensed: Sensed) -> tuple[NDArray[Any], NDArray[Any] | None]:
    """Return what stepping through a recording gives, (T, n) each [N, N m]."""
    state, rows = estimator.init(), []
    for k in range(len(sensed)):
        state, one = estimator.step(state, sensed[k])
        rows.append(one)
    stds = [row.std for row in rows if row.std is not None]
    return np.stack([row.tau_ext for row in rows]), np.stack(stds) if stds else None


def test_step_equals_estimate(estimator: Estimator, sensed: Sensed) -> None:
    """Sample by sample and all at once are equivalent."""
    whole = estimator.estimate(sensed)
    tau, std = stepped(estimator, sensed)
    np.testing.assert_allclose(tau, whole.tau_ext, atol=RELATIVE * np.abs(whole.tau_ext).max())
    assert (std is None) == (whole.std is None)
    if std is not None and whole.std is not None:
        np.testing.assert_allclose(std, whole.std, rtol=RELATIVE)


def test_the_future_does_not_matter(estimator: Estimator, sensed: Sensed) -> None:
    """An estimate is invariant to samples that come after it."""
    cut = len(sensed) // 2
    changed = {}
    for field in fields(Sensed):
        values = np.array(getattr(sensed, field.name))
        values[cut:] = values[:1]
        changed[field.name] = values
    before, after = (estimator.estimate(s).tau_ext for s in (sensed, replace(sensed, **changed)))
    size = RELATIVE * np.abs(before).max()
    np.testing.assert_allclose(before[:cut], after[:cut], atol=size)
    assert np.abs(before[cut:] - after[cut:]).max() > size


def test_it_reads_no_truth(estimator: Estimator) -> None:
    assert typing.get_type_hints(type(estimator).estimate)["sensed"] is Sensed
    assert typing.get_type_hints(type(estimator).step)["sample"] is Sensed


def test_shapes_are_those_of_its_joints(estimator: Estimator, sensed: Sensed) -> None:
    result = estimator.estimate(sensed)
    assert result.tau_ext.shape == (len(sensed), len(estimator.joints))
    assert np.isfinite(result.tau_ext).all()


def test_std_is_positive(estimator: Estimator, sensed: Sensed) -> None:
    std = estimator.estimate(sensed).std
    if std is not None:
        assert std.shape == (len(sensed), len(estimator.joints))
        assert (std > 0).all()


def test_twice_gives_the_same(estimator: Estimator, sensed: Sensed) -> None:
    first, second = estimator.estimate(sensed), estimator.estimate(sensed)
    np.testing.assert_array_equal(first.tau_ext, second.tau_ext)
    state = estimator.init()
    ones = [estimator.step(state, sensed[0])[1].tau_ext for _ in range(2)]
    np.testing.assert_array_equal(*ones)


def test_recorded_arrays_are_left_alone(estimator: Estimator, sensed: Sensed) -> None:
    before = [np.array(getattr(sensed, field.name)) for field in fields(Sensed)]
    estimator.estimate(sensed)
    estimator.step(estimator.init(), sensed[0])
    for field, array in zip(fields(Sensed), before, strict=True):
        np.testing.assert_array_equal(getattr(sensed, field.name), array)


def test_mob_net_with_a_zero_network_is_mob(full_config: dict[str, Any], network_dirs: Folders, sensed: Sensed) -> None:
    mob = build_estimator(full_config, "MOB", {}, LEVEL, RATE_HZ)
    net = build_estimator(full_config, "MOB-Net", network_dirs("MOB-Net", zero=True), LEVEL, RATE_HZ)
    where = [mob.joints.index(joint) for joint in net.joints]
    np.testing.assert_array_equal(net.estimate(sensed).tau_ext, mob.estimate(sensed).tau_ext[:, where])
