"""Time of one tick of MOB-Net at batch 1: the six networks of Table 1 against torch eager, and with the observer.

Weights are random: the time does not depend on them. All run in one thread, in turns, tick by tick.
"""

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.core.machine import one_thread
from mobnet.core.recording import Sensed
from mobnet.estimation.observe import observer_of
from mobnet.estimation.residual import ResidualEstimator
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.networks import GruNetwork
from mobnet.learning.features import limb_inputs, signals
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.robot.description import describe
from mobnet.settings.networks import Training

TICKS, WARM_UP = 3000, 200
TICK_S = 1e-3  # the robot's, section 4.1
Row = dict[str, float | str]
Tick = Callable[[Sensed], None]


def main() -> list[Row]:
    """Return a row for the networks alone and one for a whole tick: microseconds (p50, p99) and ticks above 1 ms."""
    one_thread()
    settings = load_settings(overrides={"scale": "default"})
    layout, level = settings.layout, settings.levels["all_uncertainty"]
    six = six_trainings(settings)
    models = {limb: model_of(training, layout) for limb, training in six.items()}
    networks = LimbNetworks([_network(six[limb], layout, model) for limb, model in models.items()], layout)
    known = describe(settings.robot), level.nominal_mass_ratio, settings.plant.gravity_m_s2
    observer = observer_of(*known, settings.observer.gain_hz, settings.rates.data_hz, settings.observer.torque)
    whole_tick = ResidualEstimator(observer, layout, networks)
    ticks = [stepper(networks), stepper(whole_tick), _eager(six, layout, models)]
    ours, whole, eager = times_of(ticks, layout)
    return [
        row_of("six networks, one tick, against torch eager", ours, eager),
        row_of("MOB-Net with observer, one tick, against torch eager networks alone", whole, eager),
    ]


def six_trainings(settings: Settings) -> dict[str, Training]:
    """Return the trainings of the six networks of Table 1, by limb."""
    catalogue = Catalogue(settings)
    trainings = {limb: catalogue.training("MOB-Net", limb) for limb in catalogue.method("MOB-Net").limbs}
    return {limb: training for limb, training in trainings.items() if training.network.cell == "GRU"}


def six_networks(settings: Settings) -> LimbNetworks:
    """Return those networks with their first weights, as they run on a robot."""
    layout = settings.layout
    networks = [_network(one, layout, model_of(one, layout)) for one in six_trainings(settings).values()]
    return LimbNetworks(networks, layout)


def row_of(name: str, ours: NDArray[Any], reference: NDArray[Any]) -> Row:
    """Return a row from the times of all ticks (TICKS,) [s]; the ratio is of the medians."""
    p50, p99 = np.percentile(ours, [50, 99]) * 1e6
    row: Row = {"name": name, "ours": float(p50), "reference": float(np.median(reference) * 1e6), "unit": "us"}
    late = {"p99": float(p99), "reference_p99": float(np.percentile(reference, 99) * 1e6)}
    return {
        **row,
        "ratio": float(np.median(reference) / np.median(ours)),
        **late,
        "above_1ms": int((ours > TICK_S).sum()),
    }


def times_of(ticks: list[Tick], layout: JointLayout) -> NDArray[np.float64]:
    """Return the time of each tick of each contender, (contenders, TICKS) [s], taken in turns."""
    rng = np.random.default_rng(0)
    sample = _sample(layout, rng)
    times = np.empty((len(ticks), WARM_UP + TICKS))
    for k in range(times.shape[1]):
        for i, tick in enumerate(ticks):
            started = time.perf_counter()
            tick(sample)
            times[i, k] = time.perf_counter() - started
    return times[:, WARM_UP:]


def stepper(estimator: Any) -> Tick:
    """Return a tick of something with `init` and `step`."""
    state = estimator.init()

    def tick(sample: Sensed) -> None:
        nonlocal state
        state, _ = estimator.step(state, sample)

    return tick


def _eager(trainings: Mapping[str, Training], layout: JointLayout, models: Mapping[str, LimbNetwork]) -> Tick:
    """Return a tick of the same networks in torch."""
    states = {limb: model.fresh_state(1) for limb, model in models.items()}
    columns = {limb: limb_inputs(layout, trainings[limb].network).columns for limb in models}

    @torch.inference_mode()
    def tick(sample: Sensed) -> None:
        x = signals(sample)
        for limb, model in models.items():
            hidden, states[limb] = model.cell(torch.from_numpy(x[columns[limb]])[None, None], states[limb])
            _, raw = model.head(hidden).chunk(2, dim=-1)
            torch.nn.functional.softplus(raw).clamp_min(model.std_min)

    return tick


def model_of(training: Training, layout: JointLayout) -> LimbNetwork:
    """Return a limb's network with its first weights."""
    network = training.network
    sizes = len(limb_inputs(layout, network).names), len(layout.limbs(network.joints))
    return build_network(network, *sizes, training.learning.std_min, seed=0)


def _network(training: Training, layout: JointLayout, model: LimbNetwork) -> GruNetwork:
    """Return the same network as it runs on a robot."""
    names, joints = limb_inputs(layout, training.network).names, layout.limbs(training.network.joints)
    return GruNetwork(tensors_of(model, len(names), len(joints)), training.limb, joints, names, model.std_min)


def tensors_of(model: LimbNetwork, inputs: int, joints: int) -> dict[str, NDArray[np.float32]]:
    """Return the weights of a network, and z-scores that change nothing."""
    tensors = {name: tensor.numpy() for name, tensor in model.state_dict().items()}
    for kind, count in (("input", inputs), ("target", joints)):
        tensors |= {f"{kind}.mean": np.zeros(count, np.float32), f"{kind}.std": np.ones(count, np.float32)}
    return tensors


def _sample(layout: JointLayout, rng: np.random.Generator) -> Sensed:
    """Return one random sample, the base upright."""
    q = rng.normal(0, 0.3, layout.nq)
    q[3:NQ_BASE] = [1.0, 0.0, 0.0, 0.0]
    torque = rng.normal(0, 30.0, layout.nu)
    flags, command = np.zeros(len(FEET)), np.zeros(len(COMMAND))
    return Sensed(q, rng.normal(size=layout.nv), rng.normal(size=3), torque, torque, flags, command, flags)


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.0f} against {reference:.0f} {unit} (p99 {p99:.0f} against {reference_p99:.0f}), "
              "ratio {ratio:.2f}, {above_1ms} ticks above 1 ms".format(**row))  # fmt: skip
