"""Recordings: segments around falls, determinism, errors in one line, and the walk itself."""

import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.steps import DURATION, STEP_X, STEP_Y, TURN
from mobnet.control.walker import foot_yaw
from mobnet.core.columns import FEET
from mobnet.core.errors import SimulationError
from mobnet.core.recording_file import read_recording
from mobnet.settings.data import RecordingSettings
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.record import collect, record
from mobnet.simulation.self_collision import Clearance
from mobnet.simulation.simulator import Simulator

RECORDING = RecordingSettings(
    fall_height_m=0.65, dropped_before_fall_s=3.0, chunk_s=1.0, settle_s=2.0, clearance_hz=50.0, episode_s=1000.0,
    episode_steps=4000,
)  # fmt: skip
RATE_HZ = 10.0
Walk = Callable[..., WalkSettings]
TERRAINS = ("a", "b", "c")


class Faller:
    """Stands in for a simulator: every episode lasts as many samples as planned, numbered from its start."""

    def __init__(self, episodes):
        self.episodes, self.at, self.episode = iter(episodes), 0, 0
        self.length, self.width, self.simulated = 0.0, 2, 0
        self.motions = []

    @property
    def setting(self):
        """The terrain of the episode; each has another."""
        return SimpleNamespace(terrain=TERRAINS[(self.episode - 1) % len(TERRAINS)])

    def start(self, motion_s):
        self.length, self.at, self.episode = next(self.episodes), 0, self.episode + 1
        self.motions.append(motion_s)

    def run(self, rows):
        """Write episode and time until the fall."""
        done = int(min(len(rows), self.length - self.at))
        rows[:done, 0], rows[:done, 1] = self.episode, self.at + np.arange(done)
        self.at += done
        self.simulated += done
        return done


def fill(episodes, seconds, **settings):
    """Return rows at 10 Hz and how a planned sequence of episodes went."""
    faller, kept = Faller(episodes), []
    recording = RECORDING.model_copy(update=settings)
    course = record(faller, seconds * 10, recording, RATE_HZ, kept.append)  # type: ignore[arg-type]
    return np.concatenate(kept), course, faller


def test_what_came_before_a_fall_is_cut_out():
    rows, course, _ = fill([100, math.inf], 12)
    assert (course.segments, course.falls) == ([(0, 50), (50, 120)], 1)
    assert rows[49].tolist() == [1, 69]  # the fall came at 100, its last 30 samples went
    assert rows[50].tolist() == [2, 20]


@pytest.mark.parametrize("length", [0, 10, 20, 35, 50])
def test_episode_too_short_to_keep_leaves_nothing(length):
    rows, course, _ = fill([length, math.inf], 4)
    assert (course.segments, course.falls) == ([(0, 40)], 1)
    assert (rows[:, 0] == 2).all()


@pytest.mark.parametrize("episode_s", [3.3, 1000.0])
def test_segments_cover_all_rows_in_order_and_are_contiguous_in_time(episode_s):
    rows, course, _ = fill([87, 61, 30, 110, *[math.inf] * 9], 25, episode_s=episode_s)
    segments = course.segments
    assert [start for start, _ in segments] == [0, *(end for _, end in segments[:-1])]
    assert segments[-1][1] == len(rows) == 250
    for start, end in segments:
        np.testing.assert_array_equal(np.diff(rows[start:end], axis=0), np.tile([0, 1], (end - start - 1, 1)))


def test_terrain_of_each_segment_is_that_of_its_episode():
    rows, course, _ = fill([87, 25, 61, math.inf], 15)
    kept = [int(rows[start, 0]) for start, _ in course.segments]
    assert kept == [1, 3, 4]
    assert course.terrains == [TERRAINS[(episode - 1) % len(TERRAINS)] for episode in kept]


def test_walk_without_a_fall_is_one_segment_an_episode_each_after_settling():
    rows, course, _ = fill([math.inf], 7)
    assert (course.segments, course.falls) == ([(0, 70)], 0)
    np.testing.assert_array_equal(rows[:, 1], 20 + np.arange(70))
    rows, course, _ = fill([math.inf] * 4, 17, episode_s=5.0)
    assert (course.segments, course.falls) == ([(0, 50), (50, 100), (100, 150), (150, 170)], 0)
    assert rows[::50, 1].tolist() == [20.0] * 4  # each settles


def test_motion_goes_on_from_what_was_kept():
    """What was dropped is moved again: the upper body's motion has no gap over the segments."""
    _, course, faller = fill([100, 40, math.inf, math.inf], 17, episode_s=8.0)
    starts = [start / RATE_HZ for start, _ in course.segments]
    assert faller.motions == [starts[0], starts[1], starts[1], starts[2]]


@pytest.mark.parametrize("chunk_s", [0.1, 0.7, 1.0, 50.0])
def test_length_of_the_chunks_changes_nothing(chunk_s):
    episodes = [100, 61, 20, 75, *[math.inf] * 5]
    reference, course, _ = fill(episodes, 30, episode_s=9.0)
    rows, other, _ = fill(episodes, 30, episode_s=9.0, chunk_s=chunk_s)
    np.testing.assert_array_equal(rows, reference)
    assert other == course


def test_samples_are_handed_on_while_the_robot_walks():
    """No more is ever held back than what a fall would drop and a chunk: memory does not grow with the duration."""
    faller, handed, held = Faller([500, math.inf]), 0, []

    def keep(rows):
        nonlocal handed
        settled = 20 * faller.episode
        held.append(faller.simulated - settled - handed)
        handed += len(rows)

    record(faller, 1000, RECORDING, RATE_HZ, keep)  # type: ignore[arg-type]
    dropped, chunk = 30, 10
    assert max(held[:40]) <= dropped + chunk
    assert len(held) > 90


def test_robot_that_keeps_falling_leaves_no_file(walk_of, tmp_path):
    settings = walk_of("flat_walk", "ideal", recording={"fall_height_m": 2.0})
    with pytest.raises(SimulationError, match="21 falls in 0 s: this setting cannot be walked"):
        collect(settings, 1, 1.0, tmp_path / "s1")
    assert not list(tmp_path.iterdir())


def test_chunks_of_a_walk_are_what_one_long_run_gives(walk_of):
    settings = RECORDING.model_copy(update={"settle_s": 0.2, "chunk_s": 0.13, "dropped_before_fall_s": 0.25})
    streamed, once = (Simulator(walk_of("random_walk", "all_uncertainty"), 1) for _ in range(2))
    kept = []
    course = record(streamed, 1000, settings, 1000.0, kept.append)
    once.start(0.0)
    rows = np.zeros((1200, once.width), dtype=np.float32)
    assert once.run(rows) == 1200
    np.testing.assert_array_equal(np.concatenate(kept), rows[200:])
    assert (course.segments, course.terrains) == ([(0, 1000)], [once.setting.terrain])
    assert {len(chunk) for chunk in kept[:-1]} == {130}


def test_pushed_robot_falls_and_walks_again(simulate):
    """A shove of 2 kN for a whole episode; the next one is left alone."""
    simulator = simulate("flat_walk", "ideal")
    start = simulator.start
    body = simulator.world.model.body(simulator.robot.base).id
    starts = []

    def push_first(motion_s):
        starts.append(motion_s)
        start(motion_s)
        simulator.world.data.xfrc_applied[body, 1] = 2000.0 if len(starts) == 1 else 0.0

    simulator.start, kept = push_first, []
    course = record(simulator, 1000, RECORDING.model_copy(update={"settle_s": 0.5}), 1000.0, kept.append)
    assert (course.segments, course.falls, len(starts)) == ([(0, 1000)], 1, 2)
    rows = np.concatenate(kept)
    assert np.isfinite(rows).all()
    assert rows[:, 2].min() > 0.8


@pytest.fixture
def collected(walk_of, layout, tmp_path):
    """A function (scenario or settings, level, seed, seconds, **sections) -> the recording that was collected."""

    def make(walk, level, seed, seconds, **sections):
        settings = walk_of(walk, level, **sections) if isinstance(walk, str) else walk
        collect(settings, seed, seconds, tmp_path / "recording")
        return read_recording(tmp_path / "recording", layout)

    return make


def test_same_seed_gives_the_same_bytes_and_another_does_not(walk_of, tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        collect(walk_of("random_walk", "all_uncertainty"), seed, 0.5, tmp_path / name)
    a, b, c = ((tmp_path / f"{name}.parquet").read_bytes() for name in "abc")
    assert a == b
    assert a != c


def test_file_says_what_it_holds(collected):
    recording = collected("forward_walk", "sensor_noise", 4, 0.3)
    meta = recording.meta
    assert (meta["scenario"], meta["level"], meta["seed"], meta["falls"]) == ("forward_walk", "sensor_noise", 4, 0)
    assert (recording.rate_hz, recording.segments, len(recording.sensed)) == (1000.0, ((0, 300),), 300)
    np.testing.assert_allclose(np.linalg.norm(recording.sensed.q[:, 3:7], axis=1), 1, atol=1e-6)


def test_file_names_the_terrain_of_each_segment(walk_of, collected):
    anywhere = {"random_walk": {"terrain": ["checks", "flat"]}}
    short = {"episode_s": 0.2, "settle_s": 0.1}
    settings = walk_of("random_walk", "all_uncertainty", recording=short, scenarios=anywhere)
    recording = collected(settings, "", 2, 1.5)
    terrains = recording.meta["terrains"]
    assert [end - start for start, end in recording.segments] == [200] * 7 + [100]
    assert len(terrains) == len(recording.segments)
    assert set(terrains) <= set(settings.scenario.terrain)
    assert len(set(terrains)) > 1


@pytest.mark.parametrize("hits", [False, True])
def test_file_says_how_near_the_robot_came_to_itself(walk_of, robot, collected, hits):
    """The reference is the clearance of the stored poses; a hand held in the chest is a collision."""
    settings = walk_of("stand", "ideal", recording={"settle_s": 0.1})
    if hits:
        posture = settings.robot.posture
        arm = posture["LA"].model_copy(update={"angle_rad": (0.0, 0.1, 1.6, -0.5, -2.1, 0.2, -1.1, 0.0)})
        held = settings.robot.model_copy(update={"posture": {**posture, "LA": arm}})
        settings = settings.model_copy(update={"robot": held})
    recording = collected(settings, "", 1, 0.5)
    nearest = Clearance(robot).nearest(recording.sensed.q[::20].astype(float))
    assert recording.meta["clearance_min_m"] == pytest.approx(nearest.min(), abs=1e-3)
    looked = 0.5 * settings.recording.clearance_hz
    assert recording.meta["self_collisions"] == (looked if hits else 0)


def test_command_is_that_of_the_step_being_made(collected):
    """Table 2's five, zero while the robot stands."""
    unsettled = {"recording": {"settle_s": 0.0}}
    walk, still = (
        np.array(collected(name, "ideal", 1, 4.0, **unsettled).sensed.command) for name in ("flat_walk", "stand")
    )
    in_place = [0.0, 0.0, 0.0, 0.7, 0.05]
    np.testing.assert_allclose(walk[0], in_place, atol=1e-6)
    np.testing.assert_allclose(walk[-1], [0.1, 0.05, np.deg2rad(8.0), 0.7, 0.05], atol=1e-6)
    assert len(np.unique(walk, axis=0)) == 2
    np.testing.assert_array_equal(still, 0)


@pytest.mark.sim
@pytest.mark.slow
def test_unpushed_robot_steps_where_it_should(simulate, run):
    """Uneven ground, random torque and all uncertainty move footfalls by less than 2 cm and 2 deg, root mean square."""
    unpushed = {"random_walk": {"pushes": []}}
    errors = step_errors(simulate("random_walk", "all_uncertainty", scenarios=unpushed), run)
    assert np.sqrt(np.mean(errors[:, :2] ** 2, axis=0)).max() < 0.02  # m
    assert np.sqrt(np.mean(errors[:, 2] ** 2)) < np.deg2rad(2)


@pytest.mark.sim
@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_full_setting_walks_20_s_and_most_steps_are_near(simulate, run, seed):
    """A pushed robot steps elsewhere to stay on its feet, so three steps of four are asked to be within 2 cm."""
    errors = step_errors(simulate("random_walk", "all_uncertainty", seed), run)
    assert (np.abs(errors[:, :2]).max(axis=1) < 0.02).mean() > 0.75


def step_errors(simulator, run):
    """Walk for 20 s; return x, y [m] and yaw [rad] of each footfall, in the other foot's frame, less the command."""
    walker, par, errors, log = simulator.walker, simulator.walker.par, [], run(simulator, 20.0)
    assert log.done == len(log.rows)
    q, air = log["q"].astype(float), log["swing"] > 0.5
    landings = sorted((row, k) for k in range(len(FEET)) for row in np.flatnonzero(air[:-1, k] & ~air[1:, k]))
    for step, (row, k) in enumerate(landings):
        command = simulator.commands[step]
        settled = row + round(0.1 * command[DURATION] * 1000)  # the foot lies flat, the other has not left
        if settled >= len(q):
            break
        update(walker.tree, q[settled], np.zeros(39), walker.gravity, walker.pose)
        yaw = foot_yaw(walker.pose, walker.feet[1 - k])
        apart = walker.pose.position[walker.feet[k]] - walker.pose.position[walker.feet[1 - k]]
        c, n, outwards = np.cos(yaw), np.sin(yaw), 1 if k == 0 else -1
        turned = np.remainder(foot_yaw(walker.pose, walker.feet[k]) - yaw + np.pi, 2 * np.pi) - np.pi
        most = np.inf if command[TURN] * outwards > 0 else par.toe_in_max_rad
        left = outwards * (par.foot_spacing_m + max(command[STEP_Y] * outwards, 0))
        errors.append([
            c * apart[0] + n * apart[1] - command[STEP_X], c * apart[1] - n * apart[0] - left,
            turned - np.clip(command[TURN], -most, most),
        ])  # fmt: skip
    assert len(errors) > 20
    return np.array(errors)


@pytest.mark.sim
def test_a_standing_scenario_stands_through_all_uncertainty(collected):
    recording = collected("stand", "all_uncertainty", 1, 10.0)
    assert recording.meta["falls"] == 0
    assert not recording.sensed.swing.any()
    assert recording.truth.contact.all()
