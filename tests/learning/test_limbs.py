"""Limb networks side by side."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.learning.features import limb_inputs
from mobnet.learning.limbs import LimbNetworks, load_limb_networks
from mobnet.learning.networks import load_network
from mobnet.learning.train import train


@pytest.fixture
def folder(small: object, tmp_path: Path) -> Path:
    small.config["sizes"]["experiments"]["left_leg"]["epochs"] = 1
    train(small.config, "FTS-e2e", "LL", 0, small.recordings, small.residuals, tmp_path / "LL", tmp_path / "state")
    return tmp_path / "LL"


def test_together_they_predict_what_each_predicts(
    folder: Path, layout: JointLayout, made_up: Callable[..., Recording]
) -> None:
    """Limbs together and each alone are equivalent."""
    network, sensed = load_network(folder), made_up(3, 0.1).sensed
    x = limb_inputs(layout, {"Q": ["LL"], "T": ["LL"]})(sensed)
    both = LimbNetworks([network, network], layout).run(sensed)
    np.testing.assert_array_equal(both.mean, np.tile(network.run(x).mean, 2))
    np.testing.assert_array_equal(both.std, np.tile(network.run(x).std, 2))


def test_a_network_of_another_limb_is_refused(folder: Path, layout: JointLayout) -> None:
    with pytest.raises(DataError, match=r"network of limb 'LL' with joints .* accepted: 'RL'"):
        load_limb_networks({"RL": folder}, layout)


def test_an_input_that_the_robot_lacks_is_named(folder: Path, layout: JointLayout) -> None:
    network = load_network(folder)
    network.input_names = ("q.tail", *network.input_names[1:])
    with pytest.raises(DataError, match=r"'q\.tail' is not a signal of this robot"):
        LimbNetworks([network], layout)
