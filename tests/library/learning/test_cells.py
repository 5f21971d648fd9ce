"""The kinds of networks of section 6.1: sizes as published, one way to run them."""

import pytest
import torch
from library_settings import network_of
from torch import nn

from mobnet.formats.network import SIZES, NetworkCell
from mobnet.learning.cells import CELLS, Block, Lstm
from mobnet.learning.model import build_network, parameter_count

STD_MIN = 1e-6
PUBLISHED = {"GRU": 83712, "LSTM": 83468, "RNN": 83628, "TCN": 83956, "MLP": 83227, "MLP-500": 756512}  # section 6.1
SMALL = {
    **{kind: NetworkCell(cell=kind, hidden=8) for kind in ("GRU", "LSTM", "RNN")},
    "TCN": NetworkCell(cell="TCN", hidden=4, kernel_steps=3, dilations=(1, 2), dropout=0.2, window_steps=5, head=6),
    "MLP": NetworkCell(cell="MLP", hidden=8, window_steps=5),
    "constant": NetworkCell(cell="constant"),
}
LOOKS_BACK = {"MLP": 4, "TCN": 4 + 2 * 2 * (1 + 2)}  # samples before the present one


def _network(cell, inputs=3, joints=2):
    return build_network(cell, inputs, joints, STD_MIN, seed=0).eval()


def _inputs(steps, lanes=4, inputs=3):
    return torch.randn(steps, lanes, inputs, generator=torch.Generator().manual_seed(0))


def test_every_kind_can_be_built():
    assert set(CELLS) == set(SIZES) == set(SMALL)


@pytest.mark.parametrize("method", PUBLISHED)
def test_size_is_the_published_one(method, settings):
    network = build_network(network_of(settings, method, "LL"), 30, 6, STD_MIN, seed=0)
    assert parameter_count(network) == PUBLISHED[method]


def test_a_constant_learns_a_mean_and_a_deviation_per_joint_and_nothing_else():
    network = _network(SMALL["constant"])
    assert parameter_count(network) == 2 * 2
    mean, std, _ = network(_inputs(5), network.fresh_state(4))
    (mean.square() + std).sum().backward()
    assert network.head.bias.grad is not None
    assert mean.shape == std.shape == (5, 4, 2)
    assert torch.equal(std, std[:1, :1].expand_as(std))


@pytest.mark.parametrize("kind", SMALL)
def test_state_carries_the_past_over_a_cut(kind):
    """In pieces and in one run are equivalent, also for pieces shorter than what a window looks back."""
    network, x = _network(SMALL[kind]), _inputs(40)
    whole = network(x, network.fresh_state(4))
    state, parts = network.fresh_state(4), []
    for piece in x.split([1, 2, 20, 17]):
        *part, state = network(piece, state)
        parts.append(part)
    for i in range(2):
        torch.testing.assert_close(torch.cat([part[i] for part in parts]), whole[i])
    torch.testing.assert_close(state, whole[2])


@pytest.mark.parametrize("kind", SMALL)
def test_it_is_causal_and_lanes_do_not_mix(kind):
    network, x = _network(SMALL[kind]), _inputs(30)
    other = x.clone()
    other[20:] += 1.0
    other[:, 1] += 1.0
    before, after = (network(signal, network.fresh_state(4))[0] for signal in (x, other))
    torch.testing.assert_close(before[:20, [0, 2, 3]], after[:20, [0, 2, 3]])
    assert torch.equal(before[20], after[20]) == (kind == "constant")


@pytest.mark.parametrize("kind", LOOKS_BACK)
def test_a_window_ends_where_it_should(kind):
    wide = SMALL[kind].model_copy(update={"hidden": 16})  # so wide that some path through the ReLUs is open
    network, x = _network(wide, inputs=1), _inputs(40, lanes=1, inputs=1).requires_grad_()
    network(x, network.fresh_state(1))[0][-1].sum().backward()
    assert x.grad is not None
    seen = x.grad[:, 0, 0].nonzero()
    assert int(seen.min()) == 39 - LOOKS_BACK[kind]
    assert network.cell.state_size == (LOOKS_BACK[kind], 1)


@pytest.mark.parametrize("kind", SMALL)
def test_a_kept_share_of_the_state_is_a_fresh_start(kind):
    """The mask of training, 0 or 1 per lane, forgets lane by lane."""
    network, x = _network(SMALL[kind]), _inputs(20)
    _, _, state = network(x, network.fresh_state(4))
    keep = torch.tensor([0.0, 1.0, 0.0, 1.0])[None, :, None]
    mixed, fresh, carried = (network(x, s)[0] for s in (state * keep, network.fresh_state(4), state))
    torch.testing.assert_close(mixed[:, ::2], fresh[:, ::2])
    torch.testing.assert_close(mixed[:, 1::2], carried[:, 1::2])


def test_mlp_is_two_matrices_on_the_last_samples():
    network, x = _network(SMALL["MLP"]), _inputs(20)
    layer = network.get_submodule("cell.layer")
    assert isinstance(layer, nn.Conv2d)
    assert layer.bias is not None
    windows = torch.cat([torch.zeros(4, 4, 3), x]).unfold(0, 5, 1).flatten(2)  # (h, B, n_in * steps)
    expected = network.head(torch.tanh(windows @ layer.weight.flatten(1).T + layer.bias))
    torch.testing.assert_close(network(x, network.fresh_state(4))[0], expected[..., :2], rtol=1e-5, atol=1e-6)


def test_block_is_the_one_of_bai_2018():
    torch.manual_seed(0)
    block, x = Block(3, 4, 3, 2, 0.5).eval(), torch.randn(1, 3, 20, 1)
    convolve = nn.functional.conv1d
    first, second, shortcut = ((m.weight[..., 0], m.bias) for m in (block.first, block.second, block.shortcut))
    inner = convolve(convolve(x[..., 0], *first, dilation=2).relu(), *second, dilation=2).relu()
    expected = (inner + convolve(x[:, :, block.past :, 0], *shortcut)).relu()
    torch.testing.assert_close(block(x)[..., 0], expected)


def test_dropout_acts_in_training_alone():
    network, x = _network(SMALL["TCN"]), _inputs(20)
    state = network.fresh_state(4)
    assert torch.equal(network(x, state)[0], network(x, state)[0])
    network.train()
    assert not torch.equal(network(x, state)[0], network(x, state)[0])


@pytest.mark.filterwarnings("ignore:TF32 acceleration")  # told of GPUs where oneDNN is turned off
@pytest.mark.parametrize("method", PUBLISHED)
def test_gradients_in_bfloat16_are_those_of_float32(method, settings):
    """At the published sizes: one of them met a NaN in torch's bfloat16 convolution."""
    cell = network_of(settings, method, "LL").model_copy(update={"dropout": 0.0})
    network = build_network(cell, 30, 6, STD_MIN, seed=0)
    x, gradients = _inputs(50, 64, 30), {}
    known = bool(torch.ops.mkldnn._is_mkldnn_bf16_supported())  # without it torch's own kernels are tried
    for precision in (torch.float32, torch.bfloat16):
        network.precision = precision
        network.zero_grad()
        with torch.backends.mkldnn.flags(enabled=known):
            mean, std, _ = network(x, network.fresh_state(64))
            (mean.square() + std).mean().backward()
        gradients[precision] = [p.grad for p in network.parameters()]
    for exact, rounded in zip(*gradients.values(), strict=True):
        torch.testing.assert_close(rounded, exact, rtol=0.05, atol=0.02 * float(exact.abs().max()))


def test_lstm_state_is_hidden_and_cell_state():
    torch.manual_seed(0)
    cell, x = Lstm(3, 8), _inputs(10)
    state = torch.randn(2, 4, 8)
    features, after = cell.run(x, state)
    expected, (h, c) = nn.LSTM.forward(cell, x, (state[:1], state[1:]))
    assert torch.equal(features, expected)
    assert torch.equal(after, torch.cat([h, c]))
