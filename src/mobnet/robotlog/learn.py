"""A network of a limb from logs of one's own: `./reproduce learn FOLDER... --robot TABLE` (docs/logs.md).

It learns, as the networks of the paper do, the residual of the observer less the external torque that is known: of a
limb that nothing touched the residual itself. What trained it, how, and the free-motion check stand in `run.json`.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.files import METRICS, RUN, check_place, read_json, sweep, write_json
from mobnet.core.options import learn_parser
from mobnet.core.printed import printed
from mobnet.core.word_checks import check_learn
from mobnet.estimation import observer
from mobnet.estimation.own import OwnLog, limb_of, read_log_folder, refuse_twice, without_friction
from mobnet.estimation.sampling import LEARNED, check_drives
from mobnet.formats.network import Limb
from mobnet.formats.robot import RobotTable
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.loading import load_network
from mobnet.learning.job import TrainingJob
from mobnet.learning.precision import in_precision, of_processor
from mobnet.learning.train import train_on
from mobnet.learning.trainer import own_device
from mobnet.robot.description import describe
from mobnet.robot.given import given_table
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.free_check import Held, course_of, free_check, held_out, lines_of
from mobnet.robotlog.labels import before, label_of, limb_data
from mobnet.robotlog.planted_check import PlantedCheck, planted_check
from mobnet.settings.lab import Lab, load_lab
from mobnet.settings.networks import Coarse, Learning, Network, Training

log = logging.getLogger(__name__)
STATE = "training"  # folder of the checkpoint, in that of the network
SEED = 0


# A network counts time in samples, so that it runs at the rate at which it learned; the times of a training are kept.
def training_of(settings: Lab, table: RobotTable, limb: str, labels: str, rate_hz: float, epochs: int) -> Training:
    """Return how a limb's network learns from a log at a rate [Hz]: as MOB-Net's does, of the same cell.

    A limb without an entry in the table's `networks` sees its own joints.
    """
    numbers = settings.robotlog.learn
    ports = table.networks.get(limb) or Limb(joints=(limb,), Q=(limb,), T=(limb,))
    # In free motion the residual follows from motion and torque alone. A network that sees both would learn to be the
    # observer, and take away every push with it.
    ports = ports.model_copy(update={"T": ()}) if labels == "free" else ports
    row = settings.networks.get(limb) or settings.networks[numbers.cell]
    learning = in_precision(settings.learning, of_processor())
    horizon = row.horizon_steps
    return Training(
        method=LEARNED,
        limb=limb,
        target="uncertainty",
        network=Network.model_validate({**vars(ports), **vars(row)}),
        learning=_at_rate(learning, rate_hz / settings.rates.data_hz),
        epochs=epochs,
        epoch_samples=max(numbers.epoch_samples, horizon * numbers.updates),
    )


def _at_rate(learning: Learning, ratio: float) -> Learning:
    """Return how a network learns at a rate that is so many times that of the configuration: strides are times."""
    phases = [(max(1, round(phase.stride * ratio)), phase.share) for phase in learning.coarse]
    strides = dict.fromkeys(stride for stride, _ in phases if stride > 1)
    coarse = list[Coarse]()
    for stride in strides:
        share = sum(share for other, share in phases if other == stride)
        coarse.append(Coarse(stride=stride, share=share))
    return learning.model_copy(update={"coarse": tuple(coarse)})


def filled(training: Training, segments: Sequence[tuple[int, int]], settings: Lab) -> Training:
    """Return a training whose batches a log fills: of a short log, fewer lanes learn at once."""
    stride = max((phase.stride for phase in training.learning.coarse), default=1)
    horizons = sum(end - start for start, end in segments) // (training.network.horizon_steps * stride)
    lanes = max(1, min(training.learning.batch_size, horizons // 4))
    epoch = training.epoch_samples or settings.robotlog.learn.epoch_samples
    lanes = max(1, min(lanes, epoch // (training.network.horizon_steps * settings.robotlog.learn.updates)))
    return training.model_copy(update={"learning": training.learning.model_copy(update={"batch_size": lanes})})


def learn(
    settings: Lab,
    table: RobotTable,
    logs: Sequence[OwnLog],
    limb: str,
    labels: str,
    epochs: int,
    out: Path,
    *,
    force: bool = False,
) -> list[str]:
    """Train a network of a limb on logs, or go on with it, and return what is printed of it.

    Raises:
        DataError: the logs lack what tells the label, differ in their sampling or are too short, or the folder holds
            another network.
        TrainingError: the loss diverged.
    """
    robot = describe(table)
    first = logs[0].sampling
    nominal = NominalModel(robot, gravity_m_s2=settings.plant.gravity_m_s2)
    known = [label_of(log, nominal, labels) for log in logs]
    training = training_of(settings, table, limb, labels, first.rate_hz, epochs)
    data = limb_data(logs, known, robot.layout, training.network)
    cut = len(data.inputs) - round(settings.robotlog.learn.held_out * len(data.inputs))
    trained = before(data, cut)
    job = TrainingJob(filled(training, trained.segments, settings), SEED, settings.seed)
    if _is_new(job.fingerprint(trained.digest, own_device()), out, force=force):
        train_on(trained, job, out, out / STATE)
    columns = robot.layout.columns(data.joints)
    units = [robot.layout.unit(joint) for joint in data.joints]
    label = np.concatenate(known)[:, columns]
    numbers = settings.robotlog.learn
    rest = held_out(load_network(out), data, cut)
    check = free_check(rest, data, label, cut, units, numbers.margin)
    planted = _planted(logs, nominal, limb, data, label, rest, settings)
    note = read_json(out / RUN)
    course = course_of(out / METRICS, note["best"]["epoch"])
    learned = {"folders": [str(log.folder) for log in logs], "recordings": [log.footer for log in logs]}
    run_note = {**learned, "labels": labels, **first.note(), "check": check.note()}
    run_note |= {"planted": planted.note()} if planted else {}
    write_json(out / RUN, {**note, **run_note})
    return [*lines_of(check, labels, numbers, course, planted), f"written: {out}"]


def _planted(
    logs: Sequence[OwnLog],
    nominal: NominalModel,
    limb: str,
    data: LimbData,
    label: Array,
    rest: Held,
    settings: Lab,
) -> PlantedCheck | None:
    """Return which detectors of a limb find pushes that are planted into what is held out.

    There is none of a network of several limbs, or of a part that is too short.
    """
    robot = nominal.robot
    gravity = settings.plant.gravity_m_s2
    if data.joints != robot.layout.limb(limb):
        return None
    observers: list[NDArray[Any]] = [data.targets[rest.rows]]
    # `calibrate` keeps the observer without the formula of friction where that finds more: it is tried here, too.
    if robot.friction:
        bare = np.concatenate([log.residual for log in without_friction(logs, robot, gravity)])
        observers.insert(0, bare[rest.rows][:, robot.layout.columns(data.joints)] - label[rest.rows])
    q = np.concatenate([log.recording.sensed.q for log in logs])[rest.rows]
    return planted_check(nominal, limb, logs[0].sampling, q, rest.segments, rest.estimate, observers, settings)


def _is_new(fingerprint: str, out: Path, *, force: bool) -> bool:
    """Return whether a network has to be trained; a DataError says that a folder holds another one."""
    if not (out / RUN).exists():
        return True
    fingerprint_there = read_json(out / RUN).get("fingerprint")
    if fingerprint_there == fingerprint:
        log.info("%s: already trained from these logs in this way", out)
        return False
    if not force:
        raise DataError(f"{out} holds another network, of other logs or options; give --force or another --out")
    return True


def run(options: Namespace) -> list[str]:
    """Train a network as the command's options say, and return what is printed."""
    check_learn(options)
    settings = load_lab()
    epochs = settings.robotlog.learn.epochs if options.epochs is None else options.epochs
    table = given_table(options.robot, settings.robot)
    limb = limb_of(table.layout, options.limb)
    out = options.out or Path(f"{limb}_net")
    check_place(out)
    logs = [read_log_folder(folder, table.layout) for folder in options.folders]
    refuse_twice(logs, "else what is held out trains too")
    for log in logs:
        check_drives(log.folder, log.sampling.drives, describe(table))
    sweep(out)
    sweep(out / STATE)
    return learn(settings, table, logs, limb, options.labels, epochs, out, force=options.force)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = learn_parser().parse_args(words)
    logging.getLogger(observer.__name__).setLevel(logging.WARNING)  # it tells of each segment
    return printed(log, lambda: run(options), "stopped; the same words go on from the last whole epoch")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
