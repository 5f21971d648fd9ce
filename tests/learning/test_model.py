"""The limb network as it is trained, Table 1."""

from __future__ import annotations

from typing import Any

import pytest
import torch

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import LimbNetwork, build_network, parameter_count

SIZES = {"LL": 83712, "RL": 83712, "RA": 144816, "LA": 144816, "W": 152406, "V": 168012}  # Table 1
STD_MIN = 1e-6


@pytest.mark.parametrize("limb", SIZES)
def test_size_is_the_published_one(limb: str, full_config: dict[str, Any], layout: JointLayout) -> None:
    row = full_config["networks"][limb]
    network = build_network(row, len(limb_inputs(layout, row).names), len(layout.limb(limb)), STD_MIN, seed=0)
    assert parameter_count(network) == SIZES[limb]


def test_state_carries_the_past_over_a_cut() -> None:
    network = LimbNetwork(3, 8, 2, STD_MIN)
    x = torch.randn(20, 4, 3, generator=torch.Generator().manual_seed(0))
    whole, whole_std, _ = network(x, network.fresh_state(4))
    first, _, state = network(x[:9], network.fresh_state(4))
    second, second_std, _ = network(x[9:], state)
    torch.testing.assert_close(torch.cat([first, second]), whole)
    torch.testing.assert_close(second_std, whole_std[9:])


def test_std_never_falls_below_its_clip() -> None:
    network = LimbNetwork(3, 8, 2, STD_MIN)
    torch.nn.init.constant_(network.head.bias, -100.0)
    _, std, _ = network(torch.zeros(5, 1, 3), network.fresh_state(1))
    assert torch.all(std == STD_MIN)


def test_initial_weights_depend_on_the_seed_alone() -> None:
    row = {"hidden": 8, "cell": "GRU"}
    before = torch.get_rng_state()
    first, again, other = (build_network(row, 3, 2, STD_MIN, seed) for seed in (1, 1, 2))
    assert torch.equal(first.head.weight, again.head.weight)
    assert not torch.equal(first.head.weight, other.head.weight)
    assert torch.equal(torch.get_rng_state(), before)


def test_an_unknown_cell_is_refused() -> None:
    with pytest.raises(ConfigError, match="'CfC' is not accepted; accepted: GRU"):
        LimbNetwork(3, 8, 2, STD_MIN, cell="CfC")
