"""The rule `motion`: a random motion of the upper body for a recording that walks with it (section 4.3).

Training seeds count from `FIRST_TRAINING_SEED`: each is one variant of one part of the base motion, and the variants of
a part share its targets.
"""

import logging
import zlib
from pathlib import Path

import numpy as np

from experiments.plan.seeds import FIRST_TRAINING_SEED
from mobnet.core.code import provenance
from mobnet.core.store import write_array
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe, for_walking
from mobnet.settings.data import Motion
from mobnet.simulation.motion import measured, plan, working_range
from mobnet.simulation.reaching import Reacher

log = logging.getLogger(__name__)


def make_motion(
    root_seed: int, robot: RobotTable, motion: Motion, name: str, seed: int, duration_s: float, out: Path
) -> None:
    """Write knots of joint targets [rad] of the joints above the legs, columns q_ref.<joint> (section 4.3).

    The motion draws by its name and by the seed of the recording that it is made for.

    Raises:
        SimulationError: the motion comes too near to the robot itself.
    """
    described = for_walking(describe(robot))
    part, variant = part_and_variant(seed, len(motion.variants))
    rng = np.random.default_rng(np.random.SeedSequence([root_seed, zlib.crc32(name.encode()), part]))
    reacher = Reacher(described, motion, working_range(motion), described.posture.angle)
    knots = plan(described, motion, reacher, variant, rng, duration_s)
    figures = {"motion": name, "seed": seed, "part": part, "variant": variant, **measured(reacher, motion, knots)}
    log.info("%s, %s: part %d in variant %d of the base motion", name, out.name, part, variant)
    meta = {"rate_hz": motion.knot_hz, **figures, "provenance": provenance()}
    write_array(out, knots, [(f"q_ref.{joint}", "rad", "joint") for joint in described.posture.joints], meta)


def part_and_variant(seed: int, variants: int) -> tuple[int, int]:
    """Return which part of the base motion a seed draws, and its variant; test seeds draw their own in variant 0."""
    index = seed - FIRST_TRAINING_SEED
    return (seed, 0) if index < 0 else (FIRST_TRAINING_SEED + index // variants, index % variants)
