"""A network of a limb from logs of one's own: `./reproduce learn FOLDER... --robot TABLE` (docs/robots.md).

It learns, as the networks of the paper do, the residual of the observer less the external torque that is known: of a
limb that nothing touched the residual itself. What trained it, how, and the free-motion check stand in `run.json`.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.code import ROOT
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import RUN, check_place, read_json, sweep, write_json
from mobnet.estimation.own import OwnLog, check_drives, limb_of, read_log_folder, refuse_twice
from mobnet.learning.deployed.networks import load_network
from mobnet.learning.device import own_device
from mobnet.learning.job import TrainingJob
from mobnet.learning.train import train_on
from mobnet.plan.precision import with_precision
from mobnet.robot.description import describe
from mobnet.robot.given import given_table
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.free_check import free_check, lines_of
from mobnet.robotlog.labels import before, check_labels, label_of, limb_data
from mobnet.robotlog.learning_words import learn_parser
from mobnet.robotlog.training import filled, training_of
from mobnet.running.printed import printed
from mobnet.settings.load import load_settings
from mobnet.settings.robot import RobotTable
from mobnet.settings.settings import Settings

log = logging.getLogger(__name__)
STATE = "training"  # folder of the checkpoint, in that of the network
SEED = 0


def learn(
    settings: Settings, table: RobotTable, logs: Sequence[OwnLog], limb: str, labels: str, epochs: int, out: Path,
    *, force: bool = False,
) -> list[str]:  # fmt: skip
    """Train a network of a limb on logs, or go on with it, and return what is printed of it.

    Raises:
        DataError: the logs lack what tells the label, differ in their sampling or are too short, or the folder holds
            another network.
        TrainingError: the loss diverged.
    """
    robot, first = describe(table), logs[0].sampling
    nominal = NominalModel(robot, gravity_m_s2=settings.plant.gravity_m_s2)
    known = [label_of(one, nominal, labels) for one in logs]
    training = training_of(settings, table, limb, labels, first.rate_hz, epochs)
    data = limb_data(logs, known, robot.layout, training.network)
    cut = len(data.inputs) - round(settings.robotlog.learn.held_out * len(data.inputs))
    trained = before(data, cut)
    job = TrainingJob(filled(training, trained.segments, settings), SEED, settings.seed)
    if _is_new(job.fingerprint(trained.digest, own_device()), out, force=force):
        train_on(trained, job, out, out / STATE)
    columns, units = robot.layout.columns(data.joints), [robot.layout.unit(joint) for joint in data.joints]
    label = np.concatenate(known)[:, columns]
    numbers = settings.robotlog.learn
    found = free_check(load_network(out), data, label, cut, units, numbers.margin)
    learned = {"folders": [str(one.folder) for one in logs], "recordings": [one.footer for one in logs]}
    told = {**learned, "labels": labels, **first.note(), "check": found.note()}
    write_json(out / RUN, {**read_json(out / RUN), **told})
    return [*lines_of(found, labels, numbers), f"written: {out}"]


def _is_new(fingerprint: str, out: Path, *, force: bool) -> bool:
    """Return whether a network has to be trained; a DataError says that a folder holds another one."""
    if not (out / RUN).exists():
        return True
    held = read_json(out / RUN).get("fingerprint")
    if held == fingerprint:
        log.info("%s: already trained from these logs in this way", out)
        return False
    if not force:
        accepted = [f"{held}, the one that is there; or --force, or another --out"]
        raise DataError(not_accepted(f"{out}: a network with the fingerprint", fingerprint, accepted))
    return True


def run(options: Namespace) -> list[str]:
    """Train a network as the command's options say, and return what is printed."""
    check_labels(options.labels)
    settings = with_precision(load_settings(), ROOT / "results" / "default")
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
    return printed(log, lambda: run(options), "stopped; the same words go on from the last whole epoch")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
