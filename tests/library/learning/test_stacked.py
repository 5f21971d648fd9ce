"""Networks that learn side by side: each as it does alone, whatever the others do."""

import ctypes
import subprocess
from dataclasses import replace

import pytest
import torch
from torch import nn

from mobnet.core.errors import ConfigError
from mobnet.core.files import CHECKPOINT, METRICS, WEIGHTS
from mobnet.formats.network import NetworkCell
from mobnet.learning.job import TrainingJob
from mobnet.learning.model import build_network
from mobnet.learning.numbers import optimiser_numbers
from mobnet.learning.soap import Soap, optimizer_of
from mobnet.learning.stacked import gates
from mobnet.learning.stacked.cells import StackedGru
from mobnet.learning.stacked.network import StackedNetwork
from mobnet.learning.stacked.optimiser import StackedOptimiser, orthogonal
from mobnet.learning.stacked.trainer import Member, StackedTrainer
from mobnet.learning.trainer import Trainer
from mobnet.settings.networks import Coarse

CPU = torch.device("cpu")
EPOCHS = 3
TENSORS = ("weight_ih_l0", "weight_hh_l0", "bias_ih_l0", "bias_hh_l0")
COARSE = (Coarse(stride=4, share=0.3), Coarse(stride=2, share=0.3))


@pytest.mark.parametrize(("inputs", "hidden"), [(30, 150), (34, 200)])  # of the leg and of the arm, Table 1
def test_gradients_are_those_of_torch(inputs, hidden):
    torch.manual_seed(1)
    alone = [nn.GRU(inputs, hidden) for _ in range(3)]
    weights = [torch.stack([gru.get_parameter(name).detach() for gru in alone]).requires_grad_() for name in TENSORS]
    x, state, given = torch.randn(3, 50, 16, inputs), torch.randn(3, 16, hidden), torch.randn(3, 50, 16, hidden)
    states = StackedGru.apply(x, state, *weights)
    (states * given).sum().backward()
    for k, gru in enumerate(alone):
        expected, _ = gru(x[k], state[k][None])
        (expected * given[k]).sum().backward()
        assert (states[k] - expected).abs().max() < 1e-6
        for name, weight in zip(TENSORS, weights, strict=True):
            own = gru.get_parameter(name).grad
            assert (weight.grad[k] - own).norm() < 1e-5 * own.norm(), name


ON_A_CPU = """
#include <math.h>
#include <stddef.h>
#define KERNEL
typedef struct { int x; } three;
three blockIdx, blockDim = {1}, threadIdx = {0};
void at(int i) { blockIdx.x = i; }
"""


class KernelsOnACpu(gates.KernelGates):
    """The text of the kernels, compiled by a C compiler and called for one thread after the other."""

    def __init__(self, folder):
        source, library = folder / "gates.c", folder / "gates.so"
        source.write_text(ON_A_CPU + gates.SOURCE)
        subprocess.run(["cc", "-Wall", "-Werror", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
        self._library = ctypes.CDLL(library)
        self._forward, self._back = (self._kernel(name) for name in ("gates_forward", "gates_back"))

    def _kernel(self, name):
        def launch(grid, block, args):
            pointers = [ctypes.c_void_p(a.data_ptr()) if isinstance(a, torch.Tensor) else ctypes.c_int(a) for a in args]
            for thread in range(grid[0] * block[0]):  # those behind the last number too
                self._library.at(thread)
                getattr(self._library, name)(*pointers)

        return launch


def test_kernels_compute_what_torch_does(tmp_path):
    assert gates.disagreement(KernelsOnACpu(tmp_path), CPU) < 1e-6


def test_kernels_that_differ_are_noticed(tmp_path, monkeypatch):
    monkeypatch.setattr(gates, "SOURCE", gates.SOURCE.replace("d * z;", "d * r;"))
    assert gates.disagreement(KernelsOnACpu(tmp_path), CPU) > gates.AGREE


def test_a_gpu_without_a_compiler_runs_in_torchs_operations(monkeypatch, caplog):
    def fail(*_):
        raise OSError("Could not find any NVRTC library")

    monkeypatch.setattr(torch.cuda, "_compile_kernel", fail)
    assert isinstance(gates.gates_of.__wrapped__(torch.device("cuda")), gates.TorchGates)
    assert "takes longer: no kernel could be compiled: Could not find any NVRTC" in caplog.text


def small_stack(small, **changes):
    """Return a training of few updates in which none draws: side by side, networks draw from one generator."""
    training = small.training(**{"batch_size": 16, "epochs": EPOCHS, **changes})
    dropout = None if training.network.dropout is None else 0.0
    return training.model_copy(update={"network": training.network.model_copy(update={"dropout": dropout})})


@pytest.fixture
def stack(small, data, tmp_path):
    """Return a function that sets up a stack of so many seeds of a training, and one that trains one of them alone."""

    def member(seed, own=data, **changes):
        training = small_stack(small, **changes)
        return Member(
            f"{training.method}-{seed}", TrainingJob(training, seed, 1), lambda: own, tmp_path / "states" / str(seed)
        )

    def stacked(seeds=(0, 1, 2), own=None, **changes):
        return StackedTrainer([member(seed, (own or {}).get(seed, data), **changes) for seed in seeds], CPU)

    def alone(seed, own=data, **changes):
        folder = tmp_path / "alone" / str(seed)
        return Trainer(TrainingJob(small_stack(small, **changes), seed, 1), own).run(folder)

    return stacked, alone, member


def shorter(data):
    """Return the same data without most of the last segment."""
    start, end = data.segments[-1]
    return replace(data, segments=(*data.segments[:-1], (start, start + (end - start) // 3)))


@pytest.mark.parametrize(
    "changes",
    [
        {"optimizer": "adam"},
        {"optimizer": "adam", "loss": "squared"},
        {"optimizer": "adam", "loss": "beta_likelihood", "coarse": COARSE},
        {"optimizer": "adam", "sequences": "windows"},
        *({"method": f"{cell}-adam", "rate_first": 1e-4} for cell in ("LSTM", "RNN", "MLP", "TCN")),
    ],
    ids=["likelihood", "squared", "coarse", "windows", "LSTM", "RNN", "MLP", "TCN"],
)
def test_each_learns_as_it_does_alone(stack, data, tmp_path, changes):
    """In float32 the order of sums differs, and updates carry that on."""
    stacked, alone, _ = stack
    own = {1: shorter(data)}
    done = stacked(own=own, **changes).run(tmp_path / "stack")
    for seed, progress in enumerate(done.progress):
        expected = alone(seed, own.get(seed, data), **changes)
        assert len(progress.epochs) == len(expected.epochs) == EPOCHS
        for one, other in zip(progress.epochs, expected.epochs, strict=True):
            assert (one.epoch, one.stride, one.rate) == (other.epoch, other.stride, other.rate)
            assert one.train_loss == pytest.approx(other.train_loss, abs=2e-3)
            assert one.validation_loss == pytest.approx(other.validation_loss, abs=2e-3)
            assert one.validation_rmse == pytest.approx(other.validation_rmse, rel=2e-3)
            assert one.gradient_norm == pytest.approx(other.gradient_norm, rel=1e-2)
        for name, weight in expected.best.items():
            assert (progress.best[name] - weight).norm() < 2e-2 * weight.norm(), name


def test_networks_with_other_losses_learn_beside_each_other(stack, tmp_path):
    _, alone, member = stack
    losses = ("likelihood", "squared", "beta_likelihood")
    members = [member(seed, optimizer="adam", loss=loss) for seed, loss in enumerate(losses)]
    done = StackedTrainer(members, CPU).run(tmp_path / "stack")
    for seed, loss in enumerate(losses):
        expected = alone(seed, optimizer="adam", loss=loss)
        progress = done.progress[seed]
        assert progress.best_epoch().epoch == expected.best_epoch().epoch
        for one, other in zip(progress.epochs, expected.epochs, strict=True):
            assert one.train_loss == pytest.approx(other.train_loss, abs=2e-3)
            assert one.validation_rmse == pytest.approx(other.validation_rmse, rel=2e-3)
            assert one.gradient_norm == pytest.approx(other.gradient_norm, rel=1e-2)


def test_a_fine_tuning_learns_where_targets_are_known(small, data, tmp_path):
    """As a leg does that is labelled in its swings alone; whole horizons of a lane, and of all lanes, are unknown."""
    targets = data.targets.copy()
    for start, end in data.segments:
        targets[start : start + (end - start) // 2] = float("nan")
        targets[end - 120 : end - 60] = float("nan")
    swings = replace(data, targets=targets)
    first = small.train(small_stack(small, epochs=1), tmp_path / "first") / WEIGHTS
    training = small_stack(small, optimizer="adam", labels="swing", loss="beta_likelihood", batch_size=4)
    jobs = [TrainingJob(training, seed, 1) for seed in (0, 1)]
    members = [Member(job.name, job, lambda: swings, tmp_path / job.name, first) for job in jobs]
    done = StackedTrainer(members, CPU).run(tmp_path / "stack")
    for job, progress in zip(jobs, done.progress, strict=True):
        expected = Trainer(job, swings, first).run(tmp_path / "alone" / job.name)
        for one, other in zip(progress.epochs, expected.epochs, strict=True):
            assert one.train_loss == pytest.approx(other.train_loss, abs=5e-3)
            assert one.validation_loss == pytest.approx(other.validation_loss, abs=5e-3)
            assert one.validation_rmse == pytest.approx(other.validation_rmse, rel=5e-3)


def test_it_learns_with_soap_as_well_as_alone(stack, tmp_path):
    """Bases of directions without a gradient are arbitrary: weights differ as those of two seeds do, errors no more."""
    stacked, alone, _ = stack
    done = stacked().run(tmp_path / "stack")
    found = [own.best_epoch().validation_rmse for own in done.progress]
    expected = [alone(seed).best_epoch().validation_rmse for seed in range(3)]
    assert min(expected) * 0.9 < sum(found) / 3 < max(expected) * 1.1


def test_soap_makes_the_updates_of_one_network(settings):
    """With a full gradient in double precision, bases differ by signs alone, which no update sees."""
    torch.set_default_dtype(torch.float64)
    try:
        torch.manual_seed(2)
        networks = [build_network(NetworkCell(cell="GRU", hidden=8), 6, 2, 1e-6, seed) for seed in range(2)]
        stacked = StackedNetwork(networks, CPU)
        learning = optimiser_numbers(settings.learning.model_copy(update={"optimizer": "soap", "basis_every": 3}))
        optimiser = StackedOptimiser(stacked.weights, stacked.width, learning)
        alone = [optimizer_of(network, learning) for network in networks]
        assert all(isinstance(own, Soap) for own in alone)
        both = torch.ones(2)
        rates = torch.tensor([0.01, 0.003])
        for update in range(10):
            gradients = {name: torch.randn_like(weight) for name, weight in stacked.weights.items()}
            for k, (network, own) in enumerate(zip(networks, alone, strict=True)):
                for name, gradient in gradients.items():
                    network.get_parameter(name).grad = gradient[k].clone()
                for group in own.param_groups:
                    group["lr"] = float(rates[k])
                own.step()
            if update == 0:
                optimiser.begin(gradients)
            optimiser.step(gradients, rates, both, first=update == 0)
            if update and update % 3 == 0:
                optimiser.renew([0, 1])
        for name, weight in stacked.weights.items():
            for k, network in enumerate(networks):
                torch.testing.assert_close(
                    weight[k].detach(), network.get_parameter(name).detach(), rtol=1e-9, atol=1e-9
                )
    finally:
        torch.set_default_dtype(torch.float32)


def test_a_basis_is_orthogonal_where_cholesky_fails():
    columns = torch.randn(3, 20, 20, generator=torch.Generator().manual_seed(3))
    columns[1, :, 10:] = columns[1, :, :10]  # of rank 10
    columns[2, 0, 0] = torch.nan
    otherwise = torch.eye(20).expand(3, 20, 20)
    found = orthogonal(columns, otherwise)
    identity = torch.eye(20)
    for one in found:
        assert (one.T @ one - identity).abs().max() < 1e-4
    assert torch.equal(found[2], identity)
    assert (found[0] @ (found[0].T @ columns[0]) - columns[0]).abs().max() < 1e-4


@pytest.mark.parametrize("optimizer", ["adam", "soap"])
def test_a_stack_that_is_killed_goes_on_to_the_same_weights(stack, optimizer, monkeypatch, tmp_path):
    stacked, _, _ = stack

    def stop(*_):
        raise KeyboardInterrupt

    changes = {"optimizer": optimizer, "coarse": COARSE}
    whole = stacked(**changes).run(tmp_path / "whole")
    for _ in range(EPOCHS):
        killed = stacked(**changes)
        monkeypatch.setattr("mobnet.learning.stacked.trainer.write_metrics", stop)  # behind each checkpoint
        with pytest.raises(KeyboardInterrupt):
            killed.run(tmp_path / "killed")
    monkeypatch.undo()
    done = stacked(**changes).run(tmp_path / "killed")
    for own, expected in zip(done.progress, whole.progress, strict=True):
        assert own.epochs == expected.epochs
        assert own.errors == expected.errors
        assert all(torch.equal(own.best[name], weight) for name, weight in expected.best.items())
    tensors = [(tmp_path / name / CHECKPOINT).stat().st_size for name in ("whole", "killed")]
    assert tensors[0] == pytest.approx(tensors[1], abs=100)  # but for the digits of the time


def test_two_stacks_are_the_same_to_the_bit(stack, tmp_path):
    stacked, _, _ = stack
    first, second = (stacked(epochs=2).run(tmp_path / name) for name in "ab")
    for own, other in zip(first.progress, second.progress, strict=True):
        assert own.epochs == other.epochs
        assert all(torch.equal(own.best[name], weight) for name, weight in other.best.items())


@pytest.mark.parametrize("how", ["bound", "nan"])
def test_a_network_that_diverges_stops_and_the_others_go_on(stack, data, how, tmp_path):
    stacked, _, member = stack
    whole = stacked().run(tmp_path / "whole")
    if how == "nan":
        wrong = data.targets.copy()
        wrong[20] = float("nan")
        broken = member(1, replace(data, targets=wrong))
    else:
        broken = member(1, divergence_loss=-100.0)
    done = StackedTrainer([member(0), broken, member(2)], CPU).run(tmp_path / "stack")
    assert [own.diverged for own in done.progress] == [False, True, False]
    assert not done.progress[1].epochs
    assert "MOB-Net-LL-s1: epoch 1: median training loss" in done.told["MOB-Net-1"]
    for k in (0, 2):
        assert done.progress[k].epochs == whole.progress[k].epochs


def test_metrics_of_each_network_stand_in_its_own_folder(stack, tmp_path):
    stacked, _, _ = stack
    stacked(epochs=2).run(tmp_path / "stack")
    texts = {(tmp_path / "states" / str(seed) / METRICS).read_text() for seed in (0, 1, 2)}
    assert len(texts) == 3
    assert all(len(text.splitlines()) == 3 for text in texts)


def test_networks_of_other_shapes_are_refused(stack, tmp_path):
    _, _, member = stack
    with pytest.raises(ConfigError, match=r"MOB-Net-1 beside MOB-Net-0: learning.batch_size: 3 .*accepted"):
        StackedTrainer([member(0), member(1, batch_size=3)], CPU)
