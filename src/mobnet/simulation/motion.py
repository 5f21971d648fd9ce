"""Random motion of the upper body (section 4.3): band-limited targets of both hands, waist and head, without collision.

The paper records a person for 15 minutes and makes four variants of it with other speeds and offset hand targets. Here
sums of sines replace the person. Training seeds count from `FIRST_TRAINING_SEED`: each is one variant of one part of
the base motion, and the variants of a part share its targets.
"""

import logging

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.special import erf

from mobnet.core.arrays import Array
from mobnet.core.errors import SimulationError
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Motion
from mobnet.simulation.reaching import Reacher

log = logging.getLogger(__name__)
BOTH_SIDES = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])  # the right side is the mirror image in y
HAND_WAVES = 6  # azimuth, elevation and distance of two hands


def plan(
    robot: RobotDescription, motion: Motion, reacher: Reacher, variant: int, rng: np.random.Generator, duration_s: float
) -> Array:
    """Return knots (T, n) [rad] that start at rest where the reacher is."""
    change = motion.variants[variant]
    limits = working_range(motion)
    time = np.arange(round(duration_s * motion.knot_hz) + 1) / motion.knot_hz
    waves = band_limited(change.speed * time, HAND_WAVES + len(limits), motion, rng)
    hands = hand_targets(shoulder(robot) + np.array(change.hand_offset_m), motion, waves[:, :HAND_WAVES])
    joints = limits.mean(axis=1) + 0.5 * np.diff(limits)[:, 0] * waves[:, HAND_WAVES:]
    share = smooth_step((time - motion.still_s) / motion.ease_s)
    place = reacher.hand_positions()
    posture = reacher.configuration.q
    knots = np.zeros((len(time), len(limits)))
    for i, s in enumerate(share):
        knots[i] = reacher.step(place + s * (hands[i] - place), posture + s * (joints[i] - posture))
    return gaussian_filter1d(knots, motion.smoothing_s * motion.knot_hz, axis=0, mode="nearest")


def measured(reacher: Reacher, settings: Motion, knots: Array) -> dict[str, float]:
    """Return the least distance [m] and the hands' speeds [m/s], seen from the pelvis, along knots (T, n) [rad]."""
    nearest, hands = reacher.look(knots)
    if nearest.min() < settings.clearance_least_m:
        when = np.argmin(nearest) / settings.knot_hz
        raise SimulationError(
            f"motion: {nearest.min():.3f} m between two solids at {when:.2f} s is not accepted; "
            f"accepted: >= {settings.clearance_least_m}"
        )
    speed = np.linalg.norm(np.gradient(hands, 1.0 / settings.knot_hz, axis=0), axis=-1)
    values = {"clearance_m": nearest.min(), "hand_speed_mean_m_s": speed.mean(), "hand_speed_max_m_s": speed.max()}
    return {name: round(float(value), 4) for name, value in values.items()}


def working_range(settings: Motion) -> Array:
    """Return the working range (n, 2) [rad] of the joints above the legs: the right arm's mirrors the left one's."""
    left = np.array(settings.arm_rad)
    return np.concatenate([settings.waist_rad, left, settings.neck_rad, -left[:, ::-1]])


def hand_targets(centre: Array, settings: Motion, waves: Array) -> Array:
    """Return hands (T, 2, 3) [m] in the chest's frame from waves (T, 6) in -1..1: azimuth, elevation, distance.

    The left hand, whose waves come first, moves around a centre (3,) [m].
    """
    spans = np.array([settings.hand_azimuth_rad, settings.hand_elevation_rad, settings.hand_distance_m])
    azimuth, elevation, distance = np.moveaxis(
        spans.mean(axis=1) + 0.5 * np.diff(spans)[:, 0] * waves.reshape(-1, 2, 3), -1, 0
    )
    across = np.cos(elevation)
    direction = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)], axis=-1)
    return (centre + distance[..., None] * direction) * BOTH_SIDES


def shoulder(robot: RobotDescription) -> Array:
    """Return the left shoulder's third centre (3,) [m] in the chest's frame, the arm's joints at zero."""
    moved = {joint.id: joint.body for joint in robot.joints}
    names = [moved[name] for name in robot.layout.limb("LA")[:3]]
    links = [body for body in robot.bodies if body.name in names]
    return np.sum([link.pos for link in links], axis=0)


def band_limited(time: Array, count: int, settings: Motion, rng: np.random.Generator) -> Array:
    """Return signals (T, count), spread evenly over -1..1, of sines within the band [Hz] at time (T,) [s]."""
    waves = settings.waves
    (lowest, highest) = settings.band_hz
    frequency = 2 * np.pi * rng.uniform(lowest, highest, (waves, count))
    phase = rng.uniform(0, 2 * np.pi, (waves, count))
    total = np.zeros((len(time), count))
    for f, p in zip(frequency, phase, strict=True):
        total += np.sin(time[:, None] * f + p)
    return erf(total / np.sqrt(waves))  # the sum is nearly normal, of variance waves / 2


def smooth_step(x: Array) -> Array:
    """Return 0 below 0, 1 above 1, and a rise between with no jump up to the second derivative (T,)."""
    x = np.clip(x, 0.0, 1.0)
    return x**3 * (10 - 15 * x + 6 * x**2)
