"""Offline wandb runs of trainings that are under way: what their metrics.csv hold, as these grow.

The workflow starts this as a process of its own (`experiments.running.processes`), so that a training neither waits for
wandb nor depends on its version. A training that was killed and goes on is logged from its first epoch again, into a
file that takes the place of the old one. They have a folder of their own, so that nothing here touches what
`wandb_runs` makes when all trainings are done.
"""

import contextlib
import logging
import os
import select
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from experiments.evaluation.measure.learning.trainings import robot_of
from experiments.evaluation.report.wandb_runs import begin, put, rows
from mobnet.core.epochs import Epoch, read_epochs
from mobnet.core.errors import DataError
from mobnet.core.files import CHECKPOINT, MEMBERS, METRICS, PARTIAL, read_json

if TYPE_CHECKING:
    from wandb import Run

RUNS = "wandb_live"  # folder of the runs, below that of results
TRAININGS = f"*/state/*/{CHECKPOINT}"  # below the results, in the folder of the plant or of a robot
PAUSE_S = 2.0  # between two looks at the trainings
NICENESS = 10

log = logging.getLogger(__name__)


@dataclass
class Live:
    """A training under way: its run, and the epochs that are in there."""

    run: "Run"
    epochs: tuple[Epoch, ...] = ()

    def log(self, state: Path) -> None:
        """Log the epochs that the folder of its checkpoint has in addition."""
        epochs, errors = read_epochs(state / METRICS)
        for row in list(rows(epochs, errors))[len(self.epochs) :]:
            self.run.log(row, step=row["epoch"], commit=True)  # else it waits for the next epoch
        self.epochs = epochs


class Follower:
    """Logs all trainings below a folder of results that go on after its start."""

    def __init__(self, results: Path, scratch: Path) -> None:
        """Take the folder of results, and a folder of the same disk for what wandb writes beside the runs."""
        self._results = results
        self._scratch = scratch
        self._live: dict[Path, Live] = {}
        self._checkpoint: dict[Path, Path] = {}  # that of each training, which networks of a stack share
        self._left = self._checkpoints()  # by an earlier run: their trainings need not go on

    def look(self) -> None:
        """Begin runs of trainings that have begun or gone on, log new epochs, and finish runs of those that ended."""
        under_way = set[Path]()
        for path, _ in self._checkpoints() - self._left:
            states = trainings_of(path)
            under_way.update(states)
            self._checkpoint |= dict.fromkeys(states, path)
        for state in sorted(under_way | self._live.keys()):
            try:
                epochs, _ = read_epochs(state / METRICS)
                live = self._live.get(state)
                # A training that was killed and goes on is logged from its first epoch again, in a new run.
                if live is None or epochs[: len(live.epochs)] != live.epochs:
                    self._end(state, 1)
                    live = self._live[state] = self._begin(state)
                live.log(state)
                if not self._checkpoint[state].exists():
                    self._end(state, 0)
            except (DataError, OSError) as error:  # a full disk, or a folder that somebody removes
                log.warning("%s: not logged: %s", state, error)
                self._end(state, 1)

    def close(self) -> None:
        """End the runs of trainings that did not end, as failed."""
        for state in list(self._live):
            self._end(state, 1)

    def _checkpoints(self) -> set[tuple[Path, int]]:
        """Return the checkpoints that there are, and their times [ns]."""
        found = set[tuple[Path, int]]()
        for path in self._results.glob(TRAININGS):
            with contextlib.suppress(FileNotFoundError):  # that training has just ended
                found.add((path, path.stat().st_mtime_ns))
        return found

    def _begin(self, state: Path) -> Live:
        """Begin the run of a training, whose folder is named by method, limb and seed, such as `MOB-Net-LL-s0`."""
        name = state.name
        method, limb, seed = name.rsplit("-", 2)
        settings = {"name": name, "robot": robot_of(state), "method": method, "limb": limb, "seed": int(seed[1:])}
        run = begin(self._scratch, name, method, limb, settings)
        runs = self._results / RUNS
        try:
            put(self._scratch, name, runs)
        except DataError:
            run.finish(exit_code=1)
            raise
        return Live(run)

    def _end(self, state: Path, status: int) -> None:
        if live := self._live.pop(state, None):
            live.run.finish(exit_code=status)


def trainings_of(checkpoint: Path) -> list[Path]:
    """Return the folders of the trainings that go on from a checkpoint: its own, or those of a stack's networks."""
    members = checkpoint.parent / MEMBERS
    return [Path(name) for name in read_json(members)["folders"]] if members.exists() else [checkpoint.parent]


def follow(results: Path, ended: Callable[[], bool]) -> None:
    """Log the trainings below a folder of results, looking at them until `ended`, which waits between two looks."""
    results.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=PARTIAL, suffix=f".{RUNS}", dir=results) as scratch:
        follower = Follower(results, Path(scratch))
        while not ended():
            follower.look()
        follower.look()
        follower.close()


def main(results: str) -> None:
    """Follow the trainings until the standard input ends, as it does with the process that holds its other end."""
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stderr)
    os.nice(NICENESS)
    follow(Path(results), lambda: bool(select.select([sys.stdin], [], [], PAUSE_S)[0]))


if __name__ == "__main__":
    main(*sys.argv[1:])
