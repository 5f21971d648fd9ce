"""What is minimised: values against closed forms, gradients against finite differences and against squared errors."""

import copy
import math
from typing import get_args

import numpy as np
import pytest
import torch

from mobnet.learning.cells import Gru
from mobnet.learning.losses import CHOSEN_BY, beta_likelihood, gaussian_loss, likelihood, objective_of, squared
from mobnet.learning.model import LimbNetwork
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.streams import epoch_plan
from mobnet.settings.networks import Loss

HORIZON = 10
STEP = 1e-5  # of a finite difference
LOSSES = get_args(Loss)


@pytest.fixture(scope="module")
def learning(settings):
    """Return a function of a loss's name that gives section `learning` with it."""
    return lambda loss, beta=0.5: settings.learning.model_copy(update={"loss": loss, "loss_beta": beta})


@pytest.fixture
def predicted():
    """Mean, standard deviation and target, float64, the first two with gradients."""
    generator = torch.Generator().manual_seed(0)
    mean, target = torch.randn(2, 20, 3, generator=generator, dtype=torch.float64)
    std = torch.rand(20, 3, generator=generator, dtype=torch.float64) + 0.1
    return mean.requires_grad_(), std.requires_grad_(), target


def network(precision=torch.float32, *, apart=False):
    """Return a small network, its first weights always the same."""
    torch.manual_seed(0)
    made = LimbNetwork(Gru(3, 16), 2, 1e-6)
    made.precision, made.std_apart = precision, apart
    return made.train()


def samples():
    """Return samples of which the inputs explain a part, with errors of very different sizes."""
    generator = torch.Generator().manual_seed(0)
    inputs, noise = torch.randn(600, 3, generator=generator), torch.randn(600, 2, generator=generator)
    return Samples(inputs, inputs[:, :2] - inputs[:, 1:] + noise * torch.tensor([0.01, 1.0]))


def trained(learner, objective, epochs=3):
    optimizer, rng = torch.optim.Adam(learner.parameters(), lr=1e-2), np.random.default_rng(0)
    for _ in range(epochs):
        plan = epoch_plan([(0, 600)], 100, HORIZON, 4, rng)
        train_epoch(learner, optimizer, samples(), plan, HORIZON, 0.1, objective=objective)
    return learner


def test_loss_is_minus_twice_the_log_of_20_without_its_constant():
    generator = torch.Generator().manual_seed(0)
    mean, target = torch.randn(2, 50, 6, generator=generator)
    std = torch.rand(50, 6, generator=generator) + 0.1
    log_density = torch.distributions.Normal(mean, std).log_prob(target)
    torch.testing.assert_close(gaussian_loss(mean, std, target), (-2 * log_density).mean() - math.log(2 * math.pi))


@pytest.mark.parametrize("loss", LOSSES)
def test_every_loss_tells_22_beside_what_it_minimises(loss, predicted):
    _, told = objective_of(loss, 0.5)(*predicted)
    torch.testing.assert_close(told, gaussian_loss(*predicted))


def test_a_beta_of_0_is_the_likelihood(predicted):
    minimised, _ = objective_of("beta_likelihood", 0.0)(*predicted)
    torch.testing.assert_close(minimised, likelihood(*predicted)[0])


@pytest.mark.parametrize("beta", [0.25, 0.5, 1.0])
def test_gradients_of_beta_nll_are_those_of_22_times_the_weight(beta, predicted):
    """The weight itself passes none: for beta 1 the mean learns as from squared errors."""
    mean, std, target = predicted
    plain = torch.autograd.grad(likelihood(mean, std, target)[0], (mean, std))
    weighed = torch.autograd.grad(beta_likelihood(mean, std, target, beta)[0], (mean, std))
    weight = std.detach() ** (2 * beta)
    for one, other in zip(plain, weighed, strict=True):
        torch.testing.assert_close(other, weight * one)
    if beta == 1.0:
        torch.testing.assert_close(weighed[0], torch.autograd.grad((mean - target).square().mean(), mean)[0])


@pytest.mark.parametrize("loss", LOSSES)
def test_gradients_are_finite_differences_with_what_passes_none_held(loss, predicted):
    """The weight of beta-NLL and the errors that sigma is fitted on stay as they are while a number moves."""
    mean, std, target = predicted
    held_std, held_error = std.detach().clone(), (mean - target).detach().clone()

    def value(mean, std):
        weight = held_std if loss == "beta_likelihood" else torch.ones_like(std)  # beta 0.5
        error = held_error if loss == "squared" else mean - target
        told = (weight * (2 * std.log() + (error / std).square())).mean()
        return told + ((mean - target).square().mean() if loss == "squared" else 0.0)

    objectives = {"likelihood": likelihood, "squared": squared,
                  "beta_likelihood": lambda *given: beta_likelihood(*given, beta=0.5)}  # fmt: skip
    found = torch.autograd.grad(objectives[loss](mean, std, target)[0], (mean, std))
    with torch.no_grad():
        for index in [(0, 0), (7, 1), (19, 2)]:
            nudge = torch.zeros_like(mean)
            nudge[index] = STEP
            nudged = [(value(mean + a, std + b), value(mean - a, std - b)) for a, b in ((nudge, 0.0), (0.0, nudge))]
            expected = [(above - below) / (2 * STEP) for above, below in nudged]
            torch.testing.assert_close([grad[index] for grad in found], expected, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("precision", [torch.float32, torch.bfloat16])
@pytest.mark.parametrize("objective", [likelihood, lambda *given: beta_likelihood(*given, beta=0.5)])
def test_weights_get_the_gradients_that_torchs_own_gru_gives_them(objective, precision):
    """Through the hand-written backward pass, in float32 and bfloat16."""
    ours, data = network(precision), samples()
    x, target = (tensor[:200].view(HORIZON, 20, -1) for tensor in (data.inputs, data.targets))
    mean, std, _ = ours(x, ours.fresh_state(20))
    objective(mean, std, target)[0].backward()
    theirs = copy.deepcopy(ours)
    theirs.zero_grad()
    raw = theirs.head(torch.nn.GRU.forward(theirs.get_submodule("cell"), x)[0])
    theirs_mean, theirs_raw = raw.chunk(2, dim=-1)
    objective(theirs_mean, torch.nn.functional.softplus(theirs_raw).clamp_min(1e-6), target)[0].backward()
    for one, other in zip(ours.parameters(), theirs.parameters(), strict=True):
        assert one.grad is not None
        assert other.grad is not None
        bound = 1e-5 if precision == torch.float32 else 0.02
        assert (one.grad - other.grad).norm() <= bound * other.grad.norm()


@pytest.mark.parametrize("precision", [torch.float32, torch.bfloat16])
def test_a_mean_by_squared_errors_is_what_it_would_be_without_a_sigma(precision):
    """Faithful: no gradient of sigma, and no clip of it, reaches a weight of the mean; so its first weights do not."""

    def alone(mean, std, target):
        return (mean - target).square().mean(), gaussian_loss(mean, std, target)

    faithful, other, plain = (network(precision, apart=True) for _ in range(3))
    with torch.no_grad():
        other.head.weight[2:] *= -3.0
    for learner, objective in ((faithful, squared), (other, squared), (plain, alone)):
        trained(learner, objective)
    for name, tensor in plain.named_parameters():
        rows = slice(0, 2) if name.startswith("head.") else slice(None)
        for learner in (faithful, other):
            torch.testing.assert_close(dict(learner.named_parameters())[name][rows], tensor[rows], rtol=0, atol=0)
    assert not torch.equal(faithful.head.weight[2:], other.head.weight[2:])


def test_sigma_is_fitted_to_what_squared_errors_leave():
    learner = trained(network(apart=True), squared, epochs=60).eval()
    data = samples()
    with torch.no_grad():
        mean, std, _ = learner(data.inputs[:, None], learner.fresh_state(1))
    error = (mean[:, 0] - data.targets).square().mean(dim=0).sqrt()
    torch.testing.assert_close(std[:, 0].mean(dim=0), error, rtol=0.35, atol=0.0)


def test_the_epoch_kept_is_chosen_by_22_where_that_is_minimised_and_else_by_the_rmse():
    assert set(CHOSEN_BY) == set(LOSSES)
    assert [loss for loss, column in CHOSEN_BY.items() if column == "validation_loss"] == ["likelihood"]
