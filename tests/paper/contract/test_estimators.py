"""One contract for every row of the configuration's methods, those that sweeps stand for included."""

import numpy as np
import pytest
from paper_settings import settings_at

from experiments.settings.catalogue import Catalogue
from mobnet.estimation.kinds.zero import ZeroEstimator

from .checks import CHECKS, the_past_matters

METHODS = list(Catalogue(settings_at()).all_methods)


@pytest.fixture(scope="module", params=METHODS)
def estimator(request, build):
    return build(request.param)


@pytest.mark.parametrize("check", CHECKS, ids=[check.__name__ for check in CHECKS])
def test_every_method_keeps_the_contract(check, estimator, sensed):
    if check is the_past_matters and isinstance(estimator, ZeroEstimator):
        assert not estimator.estimate(sensed).tau_ext.any()
    else:
        check(estimator, sensed)


def test_mob_net_with_a_zero_network_is_mob(build, sensed):
    mob, net = build("MOB"), build("MOB-Net", zero=True)
    where = [mob.joints.index(joint) for joint in net.joints]
    np.testing.assert_array_equal(net.estimate(sensed).tau_ext, mob.estimate(sensed).tau_ext[:, where])


def test_a_gray_box_with_a_zero_network_is_its_friction_model(build, sensed):
    inner, gray = build("MOB-fric-load"), build("MOB-Net-gray", zero=True)
    where = [inner.joints.index(joint) for joint in gray.joints]
    np.testing.assert_array_equal(gray.estimate(sensed).tau_ext, inner.estimate(sensed).tau_ext[:, where])


def test_the_band_pass_filters_what_the_friction_model_estimates(build, sensed):
    """A method of another is built on the other's fit."""
    inner, outer = build("MOB-fric"), build("MOB-fric-BPF")
    assert inner.joints == outer.joints
    assert np.abs(inner.estimate(sensed).tau_ext - outer.estimate(sensed).tau_ext).max() > 1.0
