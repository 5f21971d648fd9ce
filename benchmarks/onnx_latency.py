"""Time of one tick of the six networks of Table 1 in ONNX Runtime, against the project's own compiled loops.

Weights are random: the time does not depend on them. Both run in one thread, in turns, tick by tick.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.step_latency import Row, model_of, row_of, six_networks, six_trainings, stepper, tensors_of, times_of

from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.machine import one_thread
from mobnet.estimation.own import LearnedNote
from mobnet.export.contract import ObserverContract
from mobnet.export.export import RunTime, export
from mobnet.export.session import load_exported
from mobnet.export.trained import Trained
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.weights import WeightsNote
from mobnet.learning.features import limb_inputs
from mobnet.robot.description import describe
from mobnet.settings.networks import Training


def main() -> list[Row]:
    """Return one row: microseconds (p50, p99) and ticks above 1 ms."""
    one_thread()
    settings = load_settings(overrides={"scale": "default"})
    with TemporaryDirectory() as folder:
        exported = exported_networks(settings, Path(folder))
    ours, own = times_of([stepper(exported), stepper(six_networks(settings))], settings.layout)
    return [row_of("six networks in ONNX Runtime, one tick, against the project's own", ours, own)]


def exported_networks(settings: Settings, folder: Path) -> LimbNetworks:
    """Return the networks of Table 1 with their first weights, exported into a folder and read from it."""
    observer, robot = settings.observer, describe(settings.robot)
    known = {"gain_hz": observer.gain_hz, "torque": observer.torque, "gravity_m_s2": settings.plant.gravity_m_s2}
    run = RunTime(settings.rates.data_hz, ObserverContract.model_validate(known))
    networks = [_trained(one, settings) for one in six_trainings(settings).values()]
    export(networks, robot, run, [], as_plain(settings.detection.gate, GateNumbers), folder)
    return load_exported(folder, robot.layout)


def _trained(training: Training, settings: Settings) -> Trained:
    """Return a limb's network with its first weights, as it is read from a folder."""
    layout, network = settings.layout, training.network
    model, inputs, joints = model_of(training, layout), limb_inputs(layout, network).names, layout.limbs(network.joints)
    names = {"name": training.limb, "limb": training.limb, "joints": list(joints), "inputs": list(inputs)}
    note = WeightsNote(**names, std_min=model.std_min, network=network.model_dump(mode="json"))
    run = LearnedNote(limb=training.limb, target=training.target, fingerprint="-")
    return Trained(Path(), tensors_of(model, len(inputs), len(joints)), note, run, "-")


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.0f} against {reference:.0f} {unit} (p99 {p99:.0f} against {reference_p99:.0f}), "
              "ratio {ratio:.2f}, {above_1ms} ticks above 1 ms".format(**row))  # fmt: skip
