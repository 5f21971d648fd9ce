"""The rule `collect`: recordings of a scenario, and what the observer makes of each of them."""

import logging
from collections.abc import Sequence
from pathlib import Path

from experiments.jobs.observing import observe
from experiments.plan.parts import Shard
from experiments.running.stage import Stage
from mobnet.core.store import files_of
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.record import collect

log = logging.getLogger(__name__)


def collect_walks(
    settings: WalkSettings, observer: ObserverSettings, duration_s: float, shards: Sequence[Shard], stage: Stage
) -> None:
    """Simulate recordings of a scenario [s] one after another, and observe each of them as soon as it is there.

    One job makes them all, so that Python, MuJoCo and the compiled code are loaded once. One that was killed goes on
    with the recording that it was at.

    Raises:
        SimulationError: the robot keeps falling.
    """
    stage.begin()
    for number, shard in enumerate(shards, start=1):
        if stage.has(_files(shard)):
            continue
        log.info("recording %d of %d: %s", number, len(shards), shard.recording)
        recording = stage.place(shard.recording)
        residual = stage.place(shard.residual)
        collect(settings, shard.seed, duration_s, recording, shard.motion)
        known = settings.robot, settings.level, settings.plant.gravity_m_s2, observer
        observe(*known, recording, residual, settings.rates.data_hz)
    stage.publish(file for shard in shards for file in _files(shard))


def _files(shard: Shard) -> tuple[Path, ...]:
    """Return the files of a recording and of its residual, in the order in which they are written."""
    return (*files_of(shard.recording), *files_of(shard.residual))
