"""The end-to-end rival has no observer: it is its networks."""

import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.kinds.direct import DirectEstimator
from mobnet.formats.network import Limb
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.networks import GruNetwork
from mobnet.learning.deployed.tensors import GRU_TENSORS, Z_SCORES
from mobnet.learning.features import limb_inputs
from mobnet.settings.methods import Method

HIDDEN = 5


def network(limb, layout, rng):
    """Return a random network of a leg, z-scores included."""
    joints, inputs = layout.limb(limb), limb_inputs(layout, Limb(joints=(limb,), Q=(limb,), T=(limb,))).names
    gates, n_in, n_out = 3 * HIDDEN, len(inputs), len(joints)
    shapes = [(gates, n_in), (gates, HIDDEN), (gates,), (gates,), (2 * n_out, HIDDEN), (2 * n_out,)]
    shapes += [(n_in,), (n_in,), (n_out,), (n_out,)]
    names = (*GRU_TENSORS, *Z_SCORES)
    tensors = {name: rng.uniform(0.1, 1.0, shape) for name, shape in zip(names, shapes, strict=True)}
    return GruNetwork(tensors, limb, joints, inputs, 1e-6)


def test_it_returns_what_its_networks_predict(layout, made_up):
    rng = np.random.default_rng(0)
    networks = LimbNetworks([network(limb, layout, rng) for limb in ("RL", "LL")], layout)
    sensed = made_up(0, 0.1).sensed
    estimator = DirectEstimator(networks)
    result, predicted = estimator.estimate(sensed), networks.run_all([sensed])[0]
    assert estimator.joints == layout.limb("RL") + layout.limb("LL")
    np.testing.assert_array_equal(result.tau_ext, predicted.mean)
    np.testing.assert_array_equal(result.std, predicted.std)


def test_a_method_without_networks_is_refused(recipe_of):
    with pytest.raises(ConfigError, match="method 'b' of kind 'direct' names no limbs"):
        build_estimator(recipe_of("b", methods={"b": Method(kind="direct")}))
