"""A network of a limb from logs of one's own: `./reproduce learn FOLDER... --robot TABLE` (docs/robots.md).

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
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import METRICS, RUN, check_place, read_json, sweep, write_json
from mobnet.core.printed import printed
from mobnet.estimation import observer
from mobnet.estimation.own import (
    OwnLog,
    check_drives,
    limb_of,
    read_log_folder,
    refuse_twice,
    without_friction,
)
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.networks import load_network
from mobnet.learning.device import own_device
from mobnet.learning.job import TrainingJob
from mobnet.learning.train import train_on
from mobnet.robot.description import describe
from mobnet.robot.given import given_table
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.free_check import Held, course_of, free_check, held_out, lines_of
from mobnet.robotlog.labels import before, check_labels, label_of, limb_data
from mobnet.robotlog.learning_words import learn_parser
from mobnet.robotlog.planted_check import PlantedCheck, planted_check
from mobnet.robotlog.training import filled, training_of
from mobnet.settings.lab import Lab, load_lab
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)
STATE = "training"  # folder of the checkpoint, in that of the network
SEED = 0


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
    known = [label_of(one, nominal, labels) for one in logs]
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
    held = held_out(load_network(out), data, cut)
    found = free_check(held, data, label, cut, units, numbers.margin)
    planted = _planted(logs, nominal, limb, data, label, held, settings)
    note = read_json(out / RUN)
    course = course_of(out / METRICS, note["best"]["epoch"])
    learned = {"folders": [str(one.folder) for one in logs], "recordings": [one.footer for one in logs]}
    told = {**learned, "labels": labels, **first.note(), "check": found.note()}
    told |= {"planted": planted.note()} if planted else {}
    write_json(out / RUN, {**note, **told})
    return [*lines_of(found, labels, numbers, course, planted), f"written: {out}"]


def _planted(
    logs: Sequence[OwnLog],
    nominal: NominalModel,
    limb: str,
    data: LimbData,
    label: Array,
    held: Held,
    settings: Lab,
) -> PlantedCheck | None:
    """Return which detectors of a limb find pushes that are planted into what is held out.

    There is none of a network of several limbs, or of a part that is too short.
    """
    robot = nominal.robot
    gravity = settings.plant.gravity_m_s2
    if data.joints != robot.layout.limb(limb):
        return None
    observers: list[NDArray[Any]] = [data.targets[held.rows]]
    # `calibrate` keeps the observer without the formula of friction where that finds more: it is tried here, too.
    if robot.friction:
        bare = np.concatenate([one.residual for one in without_friction(logs, robot, gravity)])
        observers.insert(0, bare[held.rows][:, robot.layout.columns(data.joints)] - label[held.rows])
    q = np.concatenate([one.recording.sensed.q for one in logs])[held.rows]
    return planted_check(nominal, limb, logs[0].sampling, q, held.segments, held.estimate, observers, settings)


def _is_new(fingerprint: str, out: Path, *, force: bool) -> bool:
    """Return whether a network has to be trained; a DataError says that a folder holds another one."""
    if not (out / RUN).exists():
        return True
    held = read_json(out / RUN).get("fingerprint")
    if held == fingerprint:
        log.info("%s: already trained from these logs in this way", out)
        return False
    if not force:
        raise DataError(f"{out} holds another network, of other logs or options; give --force or another --out")
    return True


def run(options: Namespace) -> list[str]:
    """Train a network as the command's options say, and return what is printed."""
    check_labels(options.labels)
    settings = load_lab()
    epochs = settings.robotlog.learn.epochs if options.epochs is None else options.epochs
    if epochs < 1:
        raise DataError(not_accepted("--epochs", epochs, ["a whole number from 1"]))
    table = given_table(options.robot, settings)
    limb = limb_of(table.layout, options.limb)
    out = options.out or Path(f"{limb}_net")
    check_place(out)
    logs = [read_log_folder(folder, table.layout) for folder in options.folders]
    refuse_twice(logs, "else what is held out trains too")
    for one in logs:
        check_drives(one.folder, one.sampling.drives, describe(table))
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
