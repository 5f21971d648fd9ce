"""Time of one tick of the C library on one core: observer, the six networks of Table 1, a detector for each limb.

The program `src/runtime/bench.c` steps at a paced 1 kHz, as a robot does: between two ticks the core may sleep, and
other work may take its caches. A tick cannot take less than reading its weights once, so that this is what it is
compared with, in turns of the same loop: other work slows both. It also counts the calls for memory. Weights are
random: the time does not depend on them.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
from benchmarks.step_latency import six_trainings

from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegGate
from mobnet.estimation.observe import observer_of
from mobnet.export.model_file import RuntimeDetector, RuntimeNetwork, write_model_file
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.learning.deployed.weights import WeightsNote
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network
from mobnet.robot.description import describe
from mobnet.settings.networks import Training

SOURCES = Path(__file__).parents[1] / "src" / "runtime"
TICKS = 20_000
READ_SHARE, READ_SHARE_P99 = 1 / 1.6, 1 / 2  # of a read in a tick: a tick takes 1.2 to 1.4 reads, and so does its p99
THRESHOLD = 5.0  # of a ratio
Row = dict[str, float | str]


def main() -> list[Row]:
    """Return rows of the median and the 99th percentile of a tick and of a read [us], and of the calls for memory."""
    with tempfile.TemporaryDirectory() as folder:
        out, model = Path(folder) / "build", Path(folder) / "model.bin"
        write_six(model, load_settings(overrides={"scale": "default"}))
        words = ["make", "-s", "-C", str(SOURCES), f"OUT={out}", "MARCH=native", f"{out}/bench"]
        subprocess.run(words, check=True)
        done = subprocess.run([out / "bench", model, str(TICKS)], capture_output=True, text=True, check=True)
    median, p99, largest, above_1ms, read, read_p99, share, size, calls = map(float, done.stdout.split())
    tick = "C library, one tick at 1 kHz"
    against = f"{tick}, against one read of its {size / 1e6:.1f} MB of weights"
    medians = {"ours": median, "reference": read, "unit": "us", "ratio": share, "bar": READ_SHARE}
    late = {"ours": p99, "reference": read_p99, "unit": "us", "ratio": read_p99 / p99, "bar": READ_SHARE_P99}
    return [
        {"name": f"{against}, median", **medians, "max": largest, "above_1ms": above_1ms},
        {"name": f"{against}, 99th percentile", **late},
        {"name": f"{tick}, calls for memory in {TICKS} ticks", "ours": calls, "unit": "-", "at_most": 0.0},
    ]


def write_six(path: Path, settings: Settings) -> None:
    """Write a model of the six networks with their first weights, and of a detector for each limb with motors."""
    robot, rate_hz, detection = describe(settings.robot), settings.rates.data_hz, settings.detection
    known = (
        settings.levels["all_uncertainty"].nominal_mass_ratio,
        settings.plant.gravity_m_s2,
        settings.observer.gain_hz,
    )
    trainings = six_trainings(settings)
    detectors = []
    swing = as_plain(detection.gate, GateNumbers)
    for limb in trainings:
        joints = robot.layout.limb(limb)
        thresholds = np.full((1, len(joints)), THRESHOLD)
        chain = make_chain(detection.low_pass_hz, detection.hold_s, rate_hz, thresholds)
        gate = LegGate.of(swing, robot, limb, rate_hz) if limb in detection.legs else None
        if not set(joints) & set(robot.layout.virtual):
            detectors.append(RuntimeDetector(limb, joints, ("ratio",), chain, gate))
    observer = observer_of(robot, *known, rate_hz, settings.observer.torque)
    write_model_file(path, observer, [_network(one, settings) for one in trainings.values()], detectors)


def _network(training: Training, settings: Settings) -> RuntimeNetwork:
    """Return a network with its first weights."""
    layout, network, std_min = settings.layout, training.network, training.learning.std_min
    names, joints = limb_inputs(layout, network).names, layout.limbs(network.joints)
    model = build_network(network, len(names), len(joints), std_min, seed=0)
    tensors = {name: tensor.numpy() for name, tensor in model.state_dict().items()}
    for kind, count in (("input", len(names)), ("target", len(joints))):
        tensors |= {f"{kind}.mean": np.zeros(count, np.float32), f"{kind}.std": np.ones(count, np.float32)}
    row = network.model_dump(mode="json", exclude_none=True)
    told = {"name": training.limb, "limb": training.limb, "joints": [*joints], "inputs": [*names], "std_min": std_min}
    return RuntimeNetwork(tensors, WeightsNote.model_validate({**told, "network": row}))


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.1f} {unit}".format(**row))
