"""SOAP follows its paper, is Adam where nothing is to be turned, and comes back from a checkpoint as it was."""

import subprocess
import sys

import numpy as np
import pytest
import torch
from torch import nn

from mobnet.formats.network import NetworkCell
from mobnet.learning import checkpoint
from mobnet.learning.cells import Gru, Lstm, Rnn, build_cell
from mobnet.learning.checkpoint import Progress
from mobnet.learning.model import LimbNetwork
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.soap import EPSILON, Soap, optimizer_of

BETAS, BASIS, EVERY, RATE = (0.9, 0.999), 0.95, 5, 0.02


def soap(gated, others=(), gates=1):
    optimizer = Soap(gated, others, gates, BETAS, BASIS, EVERY)
    for group in optimizer.param_groups:
        group["lr"] = RATE
    return optimizer


def by_the_paper(gradients, weight):
    """Yield the weight after each update by algorithms 3 and 4 of Vyas et al. (2024), for one matrix, in NumPy.

    As in the authors' code the first gradient gives the basis alone, and columns are sorted before they are renewed.
    """
    (slow, fast), first, second = BETAS, np.zeros_like(weight), np.zeros_like(weight)
    for count, gradient in enumerate(gradients):
        if count == 0:
            left, right = (1 - BASIS) * gradient @ gradient.T, (1 - BASIS) * gradient.T @ gradient
            q_left, q_right = (np.linalg.eigh(side)[1][:, ::-1] for side in (left, right))
            yield weight
            continue
        turned = q_left.T @ gradient @ q_right
        first, second = slow * first + (1 - slow) * turned, fast * second + (1 - fast) * turned**2
        step = first / (1 - slow**count) / (np.sqrt(second / (1 - fast**count)) + EPSILON)
        weight = weight - RATE * q_left @ step @ q_right.T
        left = BASIS * left + (1 - BASIS) * gradient @ gradient.T
        right = BASIS * right + (1 - BASIS) * gradient.T @ gradient
        if count % EVERY == 0:
            first = q_left @ first @ q_right.T
            order = np.argsort(-np.diag(q_left.T @ left @ q_left), kind="stable")
            second, q_left = second[order], np.linalg.qr(left @ q_left[:, order])[0]
            order = np.argsort(-np.diag(q_right.T @ right @ q_right), kind="stable")
            second, q_right = second[:, order], np.linalg.qr(right @ q_right[:, order])[0]
            first = q_left.T @ first @ q_right
        yield weight


def test_each_gate_learns_a_quadratic_as_the_paper_has_it():
    rng, gates, rows, columns = np.random.default_rng(0), 2, 3, 3
    curved, aim = rng.normal(size=(gates, rows, rows)), rng.normal(size=(gates, rows, columns))
    curved = curved @ curved.transpose(0, 2, 1)
    weight = nn.Parameter(torch.from_numpy(rng.normal(size=(gates * rows, columns))))
    optimizer, seen, reached = soap([weight], gates=gates), [], []
    before = weight.detach().numpy().reshape(gates, rows, columns).copy()
    for _ in range(23):
        stacked = weight.view(gates, rows, columns)
        loss = (
            (stacked - torch.from_numpy(aim)) * (torch.from_numpy(curved) @ (stacked - torch.from_numpy(aim)))
        ).sum()
        optimizer.zero_grad()
        loss.backward()
        seen.append(weight.grad.numpy().reshape(gates, rows, columns).copy())
        optimizer.step()
        reached.append(weight.detach().numpy().reshape(gates, rows, columns).copy())
    for gate in range(gates):
        wanted = list(by_the_paper([one[gate] for one in seen], before[gate]))
        np.testing.assert_allclose([one[gate] for one in reached], wanted, rtol=1e-6, atol=1e-9)


def test_it_is_adam_where_the_basis_is_the_identity():
    """Of diagonal gradients, sorted, the eigenvectors are the axes; the first gradient only gives them."""
    weight, other = (nn.Parameter(torch.diag(torch.tensor([3.0, 2.0, 1.0], dtype=torch.float64))) for _ in range(2))
    optimizer, adam = soap([weight]), torch.optim.Adam([other], lr=RATE, betas=BETAS, eps=EPSILON)
    for count in range(20):
        gradient = torch.diag(torch.tensor([3.0, 2.0, 1.0], dtype=torch.float64)) * (1 + 0.1 * (count % 3))
        weight.grad, other.grad = gradient.clone(), gradient.clone()
        optimizer.step()
        if count:
            adam.step()
    assert torch.allclose(weight, other, rtol=1e-9)


def test_other_weights_learn_by_adam(settings):
    """A network of windows has no matrix of a gate."""
    learning = settings.learning.model_copy(update={"optimizer": "soap"})
    cell = NetworkCell(cell="MLP", hidden=4, window_steps=3)
    networks = []
    for name in ("soap", "adam"):
        torch.manual_seed(0)
        networks.append(LimbNetwork(build_cell(cell, 2), 1, 1e-6))
        optimizer = optimizer_of(networks[-1], optimiser_numbers(learning.model_copy(update={"optimizer": name})))
        for group in optimizer.param_groups:
            group["lr"] = RATE
        for _ in range(5):
            advance(networks[-1], optimizer, inputs=2)
    for ours, theirs in zip(*(network.parameters() for network in networks), strict=True):
        torch.testing.assert_close(ours, theirs, rtol=1e-4, atol=1e-6)


def advance(network, optimizer, inputs=3):
    optimizer.zero_grad()
    x = torch.linspace(-1.0, 1.0, 5 * 2 * inputs).view(5, 2, inputs)
    mean, std, _ = network(x, network.fresh_state(2))
    (mean.square().sum() + std.sum()).backward()
    optimizer.step()


@pytest.mark.parametrize("cell", [Gru, Lstm, Rnn])
def test_all_matrices_of_gates_are_turned_each_by_itself(cell, settings):
    network = LimbNetwork(cell(3, 8), 2, 1e-6)
    optimizer = optimizer_of(network, optimiser_numbers(settings.learning.model_copy(update={"optimizer": "soap"})))
    advance(network, optimizer)
    gates = {Gru: 3, Lstm: 4, Rnn: 1}[cell]
    turned = {tuple(state["left"].shape) for state in optimizer.state.values() if "left" in state}
    assert turned == {(gates, 8, 8)}
    assert sum("left" in state for state in optimizer.state.values()) == 2


def test_it_goes_on_from_a_checkpoint_to_the_same_weights(settings, tmp_path):
    def fresh():
        torch.manual_seed(0)
        network = LimbNetwork(Gru(3, 8), 2, 1e-6)
        learning = settings.learning.model_copy(update={"optimizer": "soap", "basis_every": 3})
        optimizer = optimizer_of(network, optimiser_numbers(learning))
        for group in optimizer.param_groups:
            group["lr"] = RATE
        return network, optimizer

    whole, resumed = fresh(), fresh()
    for _ in range(7):
        advance(*whole)
    checkpoint.save(tmp_path / "c", "print", *whole, Progress(best=checkpoint.copy_weights(whole[0])))
    checkpoint.resume(tmp_path / "c", "print", *resumed)
    for pair in (whole, resumed):
        for _ in range(4):
            advance(*pair)
    pairs = zip(whole[0].parameters(), resumed[0].parameters(), strict=True)
    assert all(torch.equal(a, b) for a, b in pairs)


def test_a_gradient_that_is_not_finite_does_not_stop_it():
    """The trainer stops a training whose loss is not finite, with what to try."""
    weight = nn.Parameter(torch.ones(2, 2))
    optimizer = soap([weight])
    weight.grad = torch.full((2, 2), torch.nan)
    optimizer.step()
    assert torch.equal(weight, torch.ones(2, 2))


def test_a_training_with_soap_does_not_wait_for_torch_s_compiler() -> None:
    """An optimiser of torch imports it when it is made, which takes as long as the rest of torch."""
    made = "import sys, torch; from mobnet.learning.soap import Soap; "
    made += "Soap([torch.nn.Parameter(torch.ones(2, 2))], [], 1, (0.9, 0.9), 0.9, 2).zero_grad(); "
    asked = "print('torch._dynamo' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", made + asked], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
