"""The rule `collect`: the recordings of a scenario on a robot."""

import logging
from collections.abc import Sequence
from pathlib import Path

from mobnet.settings.walking import WalkSettings
from mobnet.simulation.record import collect

log = logging.getLogger(__name__)


def collect_walks(
    settings: WalkSettings, duration_s: float, seeds: Sequence[int], motions: Sequence[Path], out: Path
) -> None:
    """Simulate recordings of a scenario one after another, so that MuJoCo and the compiled code are loaded once.

    Args:
        settings: the scenario on the robot.
        duration_s: of each recording [s].
        seeds: of the recordings.
        motions: of the upper body, without their endings, one for each seed; none where it stays as it is.
        out: folder, in which the recording with seed 1 is `s1`.

    Raises:
        SimulationError: the robot keeps falling.
    """
    for number, seed in enumerate(seeds):
        log.info("recording %d of %d, s%d", number + 1, len(seeds), seed)
        motion = motions[number] if motions else None
        collect(settings, seed, duration_s, out / f"s{seed}", motion)
