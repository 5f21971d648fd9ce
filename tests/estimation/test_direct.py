"""The end-to-end rival has no observer: it is its networks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.estimation.direct import DirectEstimator
from mobnet.learning.features import limb_inputs
from mobnet.learning.limbs import LimbNetworks
from mobnet.learning.networks import GRU_TENSORS, Z_SCORES, Network

HIDDEN = 5


def network(limb: str, layout: JointLayout, rng: np.random.Generator) -> Network:
    """Return a random network of a leg, z-scores included."""
    joints, inputs = layout.limb(limb), limb_inputs(layout, {"Q": [limb], "T": [limb]}).names
    gates, n_in, n_out = 3 * HIDDEN, len(inputs), len(joints)
    shapes = [(gates, n_in), (gates, HIDDEN), (gates,), (gates,), (2 * n_out, HIDDEN), (2 * n_out,)]
    shapes += [(n_in,), (n_in,), (n_out,), (n_out,)]
    names = (*GRU_TENSORS, *Z_SCORES)
    tensors = {name: rng.uniform(0.1, 1.0, shape) for name, shape in zip(names, shapes, strict=True)}
    return Network(tensors, limb, joints, inputs, 1e-6)


def test_it_returns_what_its_networks_predict(layout: JointLayout, made_up: Callable[..., Recording]) -> None:
    rng = np.random.default_rng(0)
    networks = LimbNetworks([network(limb, layout, rng) for limb in ("RL", "LL")], layout)
    sensed = made_up(0, 0.1).sensed
    estimator = DirectEstimator(networks)
    result, predicted = estimator.estimate(sensed), networks.run(sensed)
    assert estimator.joints == layout.limb("RL") + layout.limb("LL")
    np.testing.assert_array_equal(result.tau_ext, predicted.mean)
    np.testing.assert_array_equal(result.std, predicted.std)
