"""The limb network as it is trained, Table 1."""

import pytest
import torch
from library_settings import network_of

from mobnet.formats.network import NetworkCell
from mobnet.learning.cells import Gru
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import LimbNetwork, build_network, parameter_count, seeded

SIZES = {"LL": 83712, "RL": 83712, "RA": 144816, "LA": 144816, "W": 152406, "V": 168012}  # Table 1
STD_MIN = 1e-6
PLAIN = NetworkCell(cell="GRU", hidden=24)
SPECTRAL = NetworkCell(cell="GRU", hidden=24, spectral=True, input_gain=16.0)


@pytest.mark.parametrize("limb", SIZES)
def test_size_is_the_published_one(limb, settings):
    row, layout = network_of(settings, "MOB-Net", limb), settings.layout
    network = build_network(row, len(limb_inputs(layout, row).names), len(layout.limb(limb)), STD_MIN, seed=0)
    assert parameter_count(network) == SIZES[limb]


def test_std_never_falls_below_its_clip():
    network = LimbNetwork(Gru(3, 8), 2, STD_MIN)
    torch.nn.init.constant_(network.head.bias, -100.0)
    _, std, _ = network(torch.zeros(5, 1, 3), network.fresh_state(1))
    assert torch.all(std == STD_MIN)


def test_initial_weights_depend_on_the_seed_alone():
    before = torch.get_rng_state()
    first, again, other = (build_network(PLAIN, 3, 2, STD_MIN, seed) for seed in (1, 1, 2))
    assert torch.equal(first.head.weight, again.head.weight)
    assert not torch.equal(first.head.weight, other.head.weight)
    assert torch.equal(torch.get_rng_state(), before)


def test_torch_draws_on_as_if_nothing_had_been_drawn_in_between():
    torch.manual_seed(0)
    expected = torch.rand(2)
    torch.manual_seed(0)
    first = torch.rand(1)
    with seeded(5):
        inside = torch.rand(1)
    with seeded(5):
        assert torch.equal(torch.rand(1), inside)
    assert torch.equal(torch.cat([first, torch.rand(1)]), expected)


def test_spectral_norm_adds_no_parameters_and_keeps_the_largest_singular_values_at_one():
    network = build_network(SPECTRAL, 6, 2, STD_MIN, seed=0)
    assert parameter_count(network) == parameter_count(build_network(PLAIN, 6, 2, STD_MIN, 0))
    for _ in range(200):  # a step of the power iteration each
        network(torch.zeros(1, 1, 6), network.fresh_state(1))
    tensors = network.deployable()
    assert float(torch.linalg.matrix_norm(tensors["cell.weight_hh_l0"], 2)) == pytest.approx(1.0, rel=1e-3)
    assert float(torch.linalg.matrix_norm(tensors["head.weight"], 2)) == pytest.approx(1.0, rel=1e-3)
    assert float(torch.linalg.matrix_norm(tensors["cell.weight_ih_l0"], 2)) == pytest.approx(16.0, rel=1e-3)


def test_deployed_weights_are_plain_and_predict_the_same():
    network, plain = build_network(SPECTRAL, 6, 2, STD_MIN, 0), LimbNetwork(Gru(6, 24), 2, STD_MIN)
    x = torch.randn(40, 3, 6, generator=torch.Generator().manual_seed(0))
    for parameter in network.parameters():  # as if trained
        torch.nn.init.normal_(parameter, std=0.3)
    plain.load_state_dict(network.deployable())
    with torch.no_grad():
        for ours, theirs in zip(network(x, network.fresh_state(3)), plain(x, plain.fresh_state(3)), strict=True):
            torch.testing.assert_close(ours, theirs, rtol=1e-5, atol=1e-5)


def test_every_weight_of_a_normalised_network_is_trained():
    network = build_network(SPECTRAL, 6, 2, STD_MIN, seed=0)
    mean, std, _ = network(torch.randn(5, 3, 6), network.fresh_state(3))
    (mean + std).square().sum().backward()
    assert all(p.grad is not None and p.grad.abs().sum() > 0 for p in network.parameters())


def test_torch_runs_a_normalised_gru_too():
    """On a GPU torch's own forward runs the cell: it must see the norm and weights that have moved."""
    network = build_network(SPECTRAL, 6, 2, STD_MIN, seed=0).eval()
    x, state = torch.randn(10, 3, 6), network.fresh_state(3)
    with torch.no_grad():
        for parameter in network.parameters():
            parameter += torch.randn_like(parameter)
        ours, theirs = network.cell.run(x, state)[0], torch.nn.GRU.forward(network.cell, x, state)[0]
    torch.testing.assert_close(ours, theirs, rtol=1e-5, atol=1e-5)


def test_products_are_rounded_in_training_alone():
    """What is validated is what runs on the robot, in float32."""
    network = build_network(PLAIN, 6, 2, STD_MIN, seed=0)
    x, state = torch.randn(20, 4, 6, generator=torch.Generator().manual_seed(0)), network.fresh_state(4)
    exact = network(x, state)
    network.precision = torch.bfloat16
    assert not torch.equal(network(x, state)[0], exact[0])
    assert all(tensor.dtype == torch.float32 for tensor in network(x, state))
    network.eval()
    assert all(torch.equal(a, b) for a, b in zip(network(x, state), exact, strict=True))
