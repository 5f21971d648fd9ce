"""Recordings: segments around falls, determinism, errors in one line, and the walk itself."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.parameters import DURATION, STEP_X, STEP_Y, TURN
from mobnet.core.config import load_layout
from mobnet.core.errors import ConfigError, SimulationError
from mobnet.core.recording import FEET, recording_width
from mobnet.core.store import read_array, read_recording
from mobnet.estimation.observe import observe
from mobnet.simulation.record import Simulator, collect, record

SETTINGS = {"chunk_s": 1.0, "settle_s": 2.0, "dropped_before_fall_s": 3.0}


class Faller:
    """Stands in for a simulator: every episode lasts as many samples as planned, numbered from its start."""

    def __init__(self, episodes: list[float]) -> None:
        self.episodes, self.at, self.episode = iter(episodes), 0, 0
        self.length = 0.0

    def start(self) -> None:
        """Begin the next episode."""
        self.length, self.at, self.episode = next(self.episodes), 0, self.episode + 1

    def run(self, rows: np.ndarray) -> int:
        """Write episode and time until the fall."""
        done = int(min(len(rows), self.length - self.at))
        rows[:done, 0], rows[:done, 1] = self.episode, self.at + np.arange(done)
        self.at += done
        return done


def fill(episodes: list[float], seconds: int) -> tuple[np.ndarray, list[tuple[int, int]], int]:
    """Return rows at 10 Hz, segments and falls of a planned sequence of episodes."""
    rows = np.zeros((seconds * 10, 2), dtype=np.float32)
    return rows, *record(Faller(episodes), rows, SETTINGS, 10.0)


def test_walk_without_a_fall_is_one_segment_after_settling() -> None:
    rows, segments, falls = fill([math.inf], 7)
    assert (segments, falls) == ([(0, 70)], 0)
    np.testing.assert_array_equal(rows[:, 1], 20 + np.arange(70))


def test_what_came_before_a_fall_is_cut_out() -> None:
    rows, segments, falls = fill([100, math.inf], 12)
    assert (segments, falls) == ([(0, 50), (50, 120)], 1)
    assert rows[49].tolist() == [1, 69]  # the fall came at 100, its last 30 samples went
    assert rows[50].tolist() == [2, 20]


@pytest.mark.parametrize("length", [0, 10, 20, 35, 50])
def test_episode_too_short_to_keep_leaves_nothing(length: int) -> None:
    rows, segments, falls = fill([length, math.inf], 4)
    assert (segments, falls) == ([(0, 40)], 1)
    assert (rows[:, 0] == 2).all()


def test_segments_cover_all_rows_in_order_and_are_contiguous_in_time() -> None:
    rows, segments, falls = fill([87, 61, 30, 110, math.inf], 25)
    assert falls == 4
    assert [start for start, _ in segments] == [0, *(end for _, end in segments[:-1])]
    assert segments[-1][1] == len(rows)
    for start, end in segments:
        np.testing.assert_array_equal(np.diff(rows[start:end], axis=0), np.tile([0, 1], (end - start - 1, 1)))


def test_setting_that_cannot_be_walked_is_refused() -> None:
    with pytest.raises(SimulationError, match=r"21 falls in 0 s: this setting cannot be walked"):
        fill([15] * 30, 5)


def test_pushed_robot_falls_and_walks_again(simulate: Callable) -> None:
    """A shove of 2 kN for a whole episode; the next one is left alone."""
    simulator = simulate("flat_walk", "ideal")
    layout, data, start = simulator.robot.layout, simulator.world.data, simulator.start
    body = simulator.world.model.body(simulator.robot.base).id
    starts = []

    def push_first() -> None:
        starts.append(len(starts))
        data.xfrc_applied[body, 1] = 2000.0 if len(starts) == 1 else 0.0
        start()

    simulator.start = push_first
    rows = np.zeros((1000, recording_width(layout)), dtype=np.float32)
    segments, falls = record(simulator, rows, {**SETTINGS, "settle_s": 0.5}, 1000.0)
    assert (segments, falls, len(starts)) == ([(0, 1000)], 1, 2)
    assert np.isfinite(rows).all()
    assert rows[:, 2].min() > 0.8


def test_same_seed_gives_the_same_bytes_and_another_does_not(config: dict[str, Any], tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        collect(config, "random_walk", "all_uncertainty", seed, 0.5, tmp_path / name)
    a, b, c = ((tmp_path / f"{name}.parquet").read_bytes() for name in "abc")
    assert a == b
    assert a != c


def test_file_says_what_it_holds(config: dict[str, Any], layout: Any, tmp_path: Path) -> None:
    collect(config, "forward_walk", "sensor_noise", 4, 0.3, tmp_path / "s4")
    recording = read_recording(tmp_path / "s4", layout)
    meta = recording.meta
    assert (meta["scenario"], meta["level"], meta["seed"], meta["falls"]) == ("forward_walk", "sensor_noise", 4, 0)
    assert (recording.rate_hz, recording.segments, len(recording.sensed)) == (1000.0, ((0, 300),), 300)
    np.testing.assert_allclose(np.linalg.norm(recording.sensed.q[:, 3:7], axis=1), 1, atol=1e-6)


@pytest.mark.parametrize(
    ("scenario", "level", "seconds", "message"),
    [
        ("moon_walk", "ideal", 1.0, "scenario: 'moon_walk' is not accepted; accepted: "),
        ("forward_walk", "perfect", 1.0, "level: 'perfect' is not accepted; accepted: all_uncertainty, ideal, "),
        ("forward_walk", "ideal", -1.0, "duration_s: -1.0 is not accepted; accepted: > 0"),
        ("forward_walk", "ideal", 0.0, "duration_s: 0.0 is not accepted"),
        ("forward_walk", "ideal", math.nan, "duration_s: nan is not accepted"),
    ],
)
def test_errors_are_one_line_and_name_the_value(
    config: dict[str, Any], tmp_path: Path, scenario: str, level: str, seconds: float, message: str
) -> None:
    with pytest.raises(ConfigError, match=message) as caught:
        collect(config, scenario, level, 1, seconds, tmp_path / "s1")
    assert "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_unknown_terrain_of_a_scenario_is_named(config: dict[str, Any], tmp_path: Path) -> None:
    config["scenarios"]["flat_walk"]["terrain"] = "stairs"
    with pytest.raises(ConfigError, match="terrain: 'stairs' is not accepted; accepted: checks, flat"):
        collect(config, "flat_walk", "ideal", 1, 1.0, tmp_path / "s1")


@pytest.mark.sim
@pytest.mark.slow
def test_residual_of_the_ideal_level_meets_the_row_of_table_5(
    config: dict[str, Any], layout: Any, tmp_path: Path
) -> None:
    collect(config, "forward_walk", "ideal", 1, 10.0, tmp_path / "s1")
    observe(config, tmp_path / "s1", tmp_path / "r1")
    array, _ = read_array(tmp_path / "r1")
    residual, truth = np.split(np.asarray(array, dtype=float), 2, axis=1)
    rmse = dict(zip(layout.names, np.sqrt(np.mean((residual - truth) ** 2, axis=0)), strict=True))
    mean = {limb: np.mean([rmse[joint] for joint in layout.limb(limb)]) for limb in ("LL", "RL")}
    assert max(mean.values()) <= 0.02
    assert max(rmse[joint] for joint in layout.virtual[:3]) <= 0.1
    assert max(rmse[joint] for joint in layout.virtual[3:]) <= 0.05


@pytest.mark.sim
@pytest.mark.slow
def test_full_setting_walks_20_s_and_steps_where_it_should(simulate: Callable, run: Callable) -> None:
    simulator = simulate("random_walk", "all_uncertainty")
    log = run(simulator, 20.0)
    assert log.done == len(log.rows)
    errors = step_errors(simulator, log["q"].astype(float), log["swing"] > 0.5)
    assert len(errors) > 20
    assert np.sqrt(np.mean(errors[:, :2] ** 2, axis=0)).max() < 0.02  # m
    assert np.sqrt(np.mean(errors[:, 2] ** 2)) < np.deg2rad(2)


def step_errors(simulator: Simulator, q: np.ndarray, air: np.ndarray) -> np.ndarray:
    """Return x, y [m] and yaw [rad] of each footfall, in the other foot's frame, less what was commanded (n, 3)."""
    walker, par, errors = simulator.walker, simulator.walker.par, []
    landings = sorted((row, k) for k in range(len(FEET)) for row in np.flatnonzero(air[:-1, k] & ~air[1:, k]))
    for step, (row, k) in enumerate(landings):
        command = simulator.commands[step]
        settled = row + round(0.1 * command[DURATION] * 1000)  # the foot lies flat, the other has not left
        if settled >= len(q):
            break
        update(walker.tree, q[settled], np.zeros(39), walker.gravity, walker.pose)
        stance = walker.pose.rotation[walker.feet[1 - k]]
        yaw = np.arctan2(stance[1, 0], stance[0, 0])
        apart = walker.pose.position[walker.feet[k]] - walker.pose.position[walker.feet[1 - k]]
        c, n, outwards = np.cos(yaw), np.sin(yaw), 1 if k == 0 else -1
        swung = walker.pose.rotation[walker.feet[k]]
        turned = np.remainder(np.arctan2(swung[1, 0], swung[0, 0]) - yaw + np.pi, 2 * np.pi) - np.pi
        turn = (
            command[TURN]
            if command[TURN] * outwards > 0
            else np.clip(command[TURN], -par.toe_in_max_rad, par.toe_in_max_rad)
        )
        left = outwards * par.foot_spacing_m + (command[STEP_Y] if command[STEP_Y] * outwards > 0 else 0)
        errors.append(
            (c * apart[0] + n * apart[1] - command[STEP_X], c * apart[1] - n * apart[0] - left, turned - turn)
        )
    return np.array(errors)


@pytest.mark.sim
def test_a_standing_scenario_stands_through_all_uncertainty(config: dict[str, Any], tmp_path: Path) -> None:
    collect(config, "stand", "all_uncertainty", 1, 10.0, tmp_path / "stand")
    recording = read_recording(tmp_path / "stand", load_layout(Path(config["robot"])))
    assert recording.meta["falls"] == 0
    assert not recording.sensed.swing.any()
    assert recording.truth.contact.all()
