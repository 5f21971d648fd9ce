"""An epoch and a validation of stacked networks, as `optimisation` has them for one.

On a GPU a horizon is replayed as one graph, which does not wait for the host at each operation.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import torch
from torch import Tensor

from mobnet.learning.optimisation import EVERY_STEP
from mobnet.learning.stacked.network import StackedLosses, StackedNetwork, spread
from mobnet.learning.stacked.optimiser import StackedOptimiser
from mobnet.learning.stacked.samples import StackedPlan, StackedSamples

WARM_UP = 3  # calls before a graph is captured: libraries take their memory in the first ones


@contextmanager
def in_tf32() -> Iterator[None]:
    """Let a GPU multiply with TF32's 11 bits inside, as cuDNN's GRU does, from float32 into float32.

    Not for an optimiser's bases, which would not be orthogonal then.
    """
    products = torch.backends.cuda.matmul
    before = products.fp32_precision
    products.fp32_precision = "tf32"
    try:
        yield
    finally:
        products.fp32_precision = before


class Replayed:
    """A function of fixed tensors, which it changes in place."""

    def __init__(self, function: Callable[[], None], device: torch.device) -> None:
        """Take a function whose operations, and whose tensors, are the same at each call."""
        self._function = function
        self._device = device
        self._warm = 0
        self._graph: torch.cuda.CUDAGraph | None = None

    def __call__(self) -> None:
        """Call the function; on a GPU it may still be at work afterwards."""
        if self._device.type != "cuda":
            self._function()
        elif self._graph:
            self._graph.replay()
        elif self._warm < WARM_UP:
            self._warm += 1
            self._beside()
        else:
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph):
                self._function()
            self._graph = graph
            graph.replay()

    def _beside(self) -> None:
        """Call the function on a stream of its own, as what a graph captures has to have run on one before."""
        current = torch.cuda.current_stream()
        beside = torch.cuda.Stream()
        beside.wait_stream(current)
        with torch.cuda.stream(beside):
            self._function()
        current.wait_stream(beside)


class Horizons:
    """The tensors of one horizon, which every update finds in the same place: where it is, and the state before it."""

    def __init__(self, samples: StackedSamples, network: StackedNetwork, lanes: int, horizon: int) -> None:
        """Make room for so many lanes of each network, and for horizons of so many steps."""
        networks = len(network.weights["head.bias"])
        device = samples.device
        self._samples = samples
        self._count = torch.arange(horizon, device=device)
        self._steps = self._count.clone()
        self._rows = torch.zeros(networks, lanes, dtype=torch.int64, device=device)
        self._kept = torch.zeros(networks, 1, lanes, 1, device=device)
        rows, columns = network.state_size
        self._state = torch.zeros(networks, rows, lanes, columns, device=device)
        self.active = torch.zeros(networks, device=device)
        self._network = network

    def begin(self, plan: StackedPlan) -> None:
        """Begin a plan with states of zero."""
        self._steps.copy_(plan.stride * self._count)
        self._state.zero_()

    def go_to(self, plan: StackedPlan, update: int) -> None:
        """Go to an update of a plan."""
        self._rows.copy_(plan.rows[update])
        self._kept.copy_(~plan.fresh[update][:, None, :, None])
        self.active.copy_(plan.active[update])

    def predict(self, *, learning: bool) -> tuple[Tensor, Tensor, Tensor, Tensor | None]:
        """Run the horizon, carry its state on, and return mean, std and target (K, h, B, n), and which are known.

        Where every target is, the last one is None, else (K, h, B, 1).
        """
        x, target = self._samples.take(self._rows, self._steps)
        mean, std, after = self._network.run(x, self._state * self._kept, learning=learning)
        self._state.copy_(after)
        known = ~target[..., :1].isnan() if self._samples.partial else None
        return mean, std, target, known


class Updates:
    """The updates of an epoch of stacked networks."""

    def __init__(
        self,
        network: StackedNetwork,
        samples: StackedSamples,
        optimiser: StackedOptimiser,
        losses: StackedLosses,
        lanes: int,
        horizon: int,
        most_norm: float,
        scored: slice = EVERY_STEP,
    ) -> None:
        """Take what learns, from what and how.

        Args:
            network: what learns.
            samples: what it learns from.
            optimiser: makes the updates.
            losses: what is minimised.
            lanes: streams of samples side by side.
            horizon: steps from one update to the next.
            most_norm: of a network's gradient, which is clipped to it [-].
            scored: steps of a horizon that are in the loss.
        """
        self._network = network
        self._optimiser = optimiser
        self._objective = losses
        self._most_norm = most_norm
        self._scored = scored
        self._horizons = Horizons(samples, network, lanes, horizon)
        self._rates = torch.zeros_like(self._horizons.active)
        self._told = torch.zeros_like(self._horizons.active)
        self._losses = torch.zeros_like(self._rates)
        self._norms = torch.zeros_like(self._rates)
        self._replayed = Replayed(self._update, samples.device)

    def run(self, plan: StackedPlan, rates: Tensor, frozen: Tensor, done: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Learn from an epoch at rates (K,); networks that are `frozen` (K,) do not.

        `done` (K,), on the CPU, are the updates of each network before, which are counted on.

        Returns:
            Loss (22) and norm before the clip of each update, (updates, K), and which of them count, (updates, K).
        """
        self._rates.copy_(rates)
        self._horizons.begin(plan)
        totals = [plan.rows.new_zeros(len(plan), len(rates), dtype=torch.float32) for _ in range(3)]
        moves = (plan.active & ~frozen).cpu()
        for update in range(len(plan)):
            self._horizons.go_to(plan, update)
            self._horizons.active.mul_(~frozen)
            begins = not done.any()
            self._first_update() if begins else self._replayed()
            for row, value in zip(totals, (self._losses, self._norms, self._told), strict=True):
                row[update] = value
            done += moves[update]
            if not begins:
                self._renew(moves[update], done)
        losses, norms, notes = totals
        return losses, norms, notes > 0

    def _renew(self, moved: Tensor, done: Tensor) -> None:
        """Renew the bases of networks that have made as many updates of their gates as it takes."""
        # The first update of a network gives its gates a basis and moves none of them.
        due = moved & ((done - 1) % self._optimiser.basis_every == 0) & (done > 1)
        if due.any():
            self._optimiser.renew(due.nonzero()[:, 0].tolist())

    def _gradients(self) -> dict[str, Tensor]:
        """Run a horizon, note its losses, and return the clipped gradients of all weights."""
        scored = self._scored
        weights = self._network.weights
        with in_tf32():
            mean, std, target, known = self._horizons.predict(learning=True)
            known = None if known is None else known[:, scored]
            predicted = mean[:, scored], std[:, scored], target[:, scored]
            minimised, losses = self._objective.of(*predicted, known)
            given = torch.autograd.grad(minimised.sum(), list(weights.values()))
        gradients, norms = self._network.clipped(dict(zip(weights, given, strict=True)), self._most_norm)
        self._losses.copy_(losses.detach())
        self._norms.copy_(norms)
        self._told.copy_(self._horizons.active)
        if known is not None:  # a horizon without any target teaches nothing
            self._told.mul_(known.flatten(1).any(1))
        return gradients

    def _update(self) -> None:
        """Make one update."""
        self._optimiser.step(self._gradients(), self._rates, self._told)

    def _first_update(self) -> None:
        """Make the first update, which gives gated matrices a basis."""
        gradients = self._gradients()
        self._optimiser.begin(gradients)
        self._optimiser.step(gradients, self._rates, self._told, first=True)


class Validation:
    """Validations of stacked networks on plans of one size."""

    def __init__(
        self, network: StackedNetwork, samples: StackedSamples, losses: StackedLosses, lanes: int, horizon: int
    ) -> None:
        """Make room for plans of so many lanes."""
        self._objective = losses
        networks = len(network.weights["head.bias"])
        self._horizons = Horizons(samples, network, lanes, horizon)
        self._used = torch.zeros(networks, 1, lanes, 1, dtype=torch.bool, device=samples.device)
        self._loss = torch.zeros(networks, device=samples.device)
        self._squares = torch.zeros(networks, samples.joints, device=samples.device)
        self._counted = torch.zeros_like(self._loss)
        self._replayed = Replayed(self._horizon, samples.device)

    def run(self, plan: StackedPlan) -> tuple[Tensor, Tensor]:
        """Return the mean loss (22) of each network (K,), and the RMSE of each joint (K, n), z-scored.

        A network none of whose targets is known gets nan.
        """
        for total in (self._loss, self._squares, self._counted):
            total.zero_()
        self._used.copy_(plan.used[:, None, :, None])
        self._horizons.begin(plan)
        for update in range(len(plan)):
            self._horizons.go_to(plan, update)
            self._replayed()
        return self._loss / self._counted, (self._squares / self._counted[:, None]).sqrt()

    @torch.no_grad()
    def _horizon(self) -> None:
        """Add the loss and the squared errors of a horizon, the mean over its samples."""
        with in_tf32():
            mean, std, target, known = self._horizons.predict(learning=False)
        counted = self._used.expand(*mean.shape[:3], 1)
        if known is not None:
            counted = counted & known
        _, loss = self._objective.of(mean, std, target, counted)
        is_counted = counted.flatten(1).any(1) * self._horizons.active
        squares = torch.where(counted, (mean - target).square(), 0.0).sum((1, 2))
        self._loss += torch.where(is_counted > 0, loss, 0.0)
        self._squares += squares / counted.sum((1, 2)).clamp(min=1) * spread(is_counted, squares)
        self._counted += is_counted
