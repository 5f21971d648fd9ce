"""One contract for every row of the configuration's methods, those that sweeps stand for included."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.core.estimator import Estimator
from mobnet.core.recording import Sensed
from mobnet.settings.load import load_settings

from .checks import CHECKS

METHODS = list(load_settings().all_methods)
Build = Callable[..., Estimator]


@pytest.fixture(scope="module", params=METHODS)
def estimator(request: pytest.FixtureRequest, build: Build) -> Estimator:
    return build(request.param)


@pytest.mark.parametrize("check", CHECKS, ids=[check.__name__ for check in CHECKS])
def test_every_method_keeps_the_contract(
    check: Callable[[Estimator, Sensed], None], estimator: Estimator, sensed: Sensed
) -> None:
    check(estimator, sensed)


def test_mob_net_with_a_zero_network_is_mob(build: Build, sensed: Sensed) -> None:
    mob, net = build("MOB"), build("MOB-Net", zero=True)
    where = [mob.joints.index(joint) for joint in net.joints]
    np.testing.assert_array_equal(net.estimate(sensed).tau_ext, mob.estimate(sensed).tau_ext[:, where])


def test_the_band_pass_filters_what_the_friction_model_estimates(build: Build, sensed: Sensed) -> None:
    """A method of another is built on the other's fit."""
    inner, outer = build("MOB-fric"), build("MOB-fric-BPF")
    assert inner.joints == outer.joints
    assert np.abs(inner.estimate(sensed).tau_ext - outer.estimate(sensed).tau_ext).max() > 1.0
