"""Thresholds of limbs that are watched all the time: false alarms come at the wanted rate, in all joints together."""

from types import SimpleNamespace

import numpy as np
import pytest

from experiments.jobs.calm import calm_parts, first_part, limb_thresholds, watched_of, window_heights
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.formats.plain import as_plain
from mobnet.reaction.numbers import WrenchDamping
from mobnet.reaction.watchers import BaseForce

RATE_HZ, HOUR_S = 10.0, 3600.0


def noise(rng, hours):
    """Return torques of two joints, of which the second one errs three times as much (T, 2)."""
    return rng.normal(size=(round(hours * HOUR_S * RATE_HZ), 2)) * [1.0, 3.0]


def calibrated(settings, torques, rate_per_h=20.0):
    rule = settings.reaction.ours.rule
    numbers = settings.detection.thresholds.model_copy(update={"rates_per_h": {rule: rate_per_h}})
    detection = settings.detection.model_copy(update={"thresholds": numbers})
    robot = SimpleNamespace(detection=detection, reaction=settings.reaction, rate_hz=RATE_HZ)
    return limb_thresholds(robot, [window_heights(robot, own) for own in torques])


def test_false_alarms_come_at_the_wanted_rate_and_each_joint_has_its_share(settings):
    rng, hours = np.random.default_rng(0), 20.0
    thresholds = calibrated(settings, [noise(rng, 0.5), noise(rng, 0.5)])
    alarms = np.abs(noise(rng, hours)) > thresholds
    windows = alarms.reshape(-1, round(RATE_HZ * settings.detection.window_s), 2).any(axis=1)
    assert windows.any(axis=1).sum() / hours == pytest.approx(20.0, rel=0.6)
    assert thresholds[1] / thresholds[0] == pytest.approx(3.0, rel=0.15)


def test_a_rarer_alarm_has_higher_thresholds(settings):
    torques = [noise(np.random.default_rng(1), 0.5)]
    assert (calibrated(settings, torques, 1.0) > calibrated(settings, torques, 20.0)).all()


def test_too_short_a_walk_is_told(settings):
    with pytest.raises(DataError, match="swings that calibrate"):
        calibrated(settings, [noise(np.random.default_rng(1), 0.01)])


def test_recordings_are_read_until_there_is_enough_of_them(settings, robot, made_up, write_pair, tmp_path):
    stems = [write_pair(tmp_path, made_up(seed=seed, seconds=2.0, segments=2))[0] for seed in range(3)]
    stems.append(tmp_path / "needed_no_more")
    reaction = settings.reaction.model_copy(update={"calm_s": 5.5})
    walker = SimpleNamespace(reaction=reaction, rate_hz=1000.0, description=robot)
    parts = list(calm_parts(walker, stems))
    assert [len(part.sensed) for part in parts] == [2000, 2000, 1500]
    assert [part.segments for part in parts] == [((0, 1000), (1000, 2000))] * 2 + [((0, 1000), (1000, 1500))]


def test_the_base_is_watched_by_the_force_on_it_and_a_limb_by_its_own_joints(settings, robot, made_up, layout):
    joints = tuple(joint for limb in ("LL", "RL", "V", "W") for joint in layout.limb(limb))
    sensed, rng = made_up(6, 0.05).sensed, np.random.default_rng(6)
    known = rng.normal(size=(len(sensed), len(joints)))
    base = BaseForce.of(
        robot, as_plain(settings.reaction.identification, WrenchDamping), settings.detection.gate.contact_height_m
    )
    walker = SimpleNamespace(description=robot, base=base)
    tau, std = np.zeros((2, len(sensed), layout.nv))
    tau[:, layout.columns(joints)], std[:, layout.columns(joints)] = known, 2.0
    estimate = Estimate(known, np.full(known.shape, 2.0))
    found = watched_of(walker, "V", joints, sensed, estimate)
    expected = base.run(sensed, Estimate(tau, std))
    assert (found.tau_ext.tolist(), found.std.tolist()) == (expected.tau_ext.tolist(), expected.std.tolist())
    waist = watched_of(walker, "W", joints, sensed, estimate)
    assert waist.tau_ext.tolist() == known[:, -len(layout.limb("W")) :].tolist()


def test_the_first_part_of_a_recording_ends_within_a_segment(made_up):
    walk = made_up(1, 2.0, segments=4)
    part = first_part(walk, 1200)
    assert (len(part.sensed), len(part.truth.tau_ext)) == (1200, 1200)
    assert part.segments == ((0, 500), (500, 1000), (1000, 1200))
    assert first_part(walk, 1000).segments == walk.segments[:2]
    assert first_part(walk, 9000).segments == walk.segments
