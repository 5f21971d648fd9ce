"""What walks teach: ratios of errors on levels of a factor over robots, and errors under hits of the knee."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import scipy.stats
from paper_settings import STATISTICS

from experiments.evaluation.measure.learning.taught import HITS, ROUGHNESS, SHARE_OF_HIT, WALKING, judged
from experiments.evaluation.measure.learning.trials import read_walks
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.tables.further.factorial import ALL, EFFECTS, effects_of, table_of
from experiments.evaluation.tables.layout import write_table
from experiments.plan.jobs import scoring
from experiments.plan.runs import TaughtRobot, Tried, TriedTask
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from experiments.settings.trials import Factors
from mobnet.core.columns import residual_columns
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.rows import read_texts
from mobnet.core.store import write_array
from mobnet.kernel.low_pass import low_pass

FIRST, LAST = 1000, 1080  # rows of a push
SHOWN = 0.6  # share of it that an observer shows
LEVELS = product((False, True), (False, True), ("random", "joystick"))
CELLS = {f"cell_{k}": Factors(*levels) for k, levels in enumerate(LEVELS)}
TORQUE = 50.0
# How the error of each robot changes with a level: without random torque, without pushes, with a joystick.
CHANGES = {"random_torque": (1.1, 1.2, 1.3), "pushes": (1.6, 1.6, 1.6), "commands": (1.5, 1.4, 1.3)}


@pytest.fixture
def found() -> dict[str, dict[str, Any]]:
    """Errors of three robots on two walks; each factor multiplies them, whatever the other ones are."""
    robots = np.array([2.0, 3.0, 4.0])
    errors: dict[str, dict[str, Any]] = {}
    for name, factors in CELLS.items():
        own = robots.copy()
        for factor, (above, _, _) in EFFECTS.items():
            if getattr(factors, factor) == above:
                own = own * CHANGES[factor]
        walks = own[:, None] * np.array([0.9, 1.1])
        errors[name] = {WALKING: walks, HITS: 2.0 * walks}
    return errors


def test_an_effect_is_the_geometric_mean_of_ratios_with_its_interval_over_robots(found: dict[str, Any]) -> None:
    effects = effects_of(found, CELLS, TORQUE, STATISTICS)
    assert len(effects) == 2 * 3 * (4 + 1)
    for factor, (_, _, title) in EFFECTS.items():
        own = rows_of(effects, name=title)
        logs = np.log(CHANGES[factor])
        reach = scipy.stats.t.ppf(0.975, 2) * logs.std(ddof=1) / np.sqrt(3)
        wanted = np.exp([logs.mean(), logs.mean() - reach, logs.mean() + reach])
        for ends in own[["value", "low", "high"]].to_numpy():
            assert ends == pytest.approx(wanted, rel=1e-6)
        levels = rows_of(own, measure=HITS)[["random_torque_nm", "pushes", "commands"]]
        assert len(levels.drop_duplicates()) == len(levels) == 5
        assert levels.isna().all(axis=1).sum() == 1


def test_of_one_robot_an_effect_has_no_interval(found: dict[str, Any]) -> None:
    alone = {name: {key: values[:1] for key, values in own.items()} for name, own in found.items()}
    effects = effects_of(alone, CELLS, TORQUE, STATISTICS)
    assert effects["value"].notna().all()
    assert effects["low"].isna().all()


def test_a_set_of_another_day_takes_no_place_of_a_cell(found: dict[str, Any]) -> None:
    """It has the factors of one of them."""
    day = {**found, "day": {key: 10.0 * values for key, values in found["cell_0"].items()}}
    with_day = effects_of(day, {**CELLS, "day": CELLS["cell_0"]}, TORQUE, STATISTICS)
    pd.testing.assert_frame_equal(with_day, effects_of(found, CELLS, TORQUE, STATISTICS))


def test_the_table_has_every_set_robot_and_effect(found: dict[str, Any], settings: Settings, tmp_path: Path) -> None:
    trial = settings.trials.factorial.model_copy(
        update={"cells": tuple(CELLS), "same_day": "cell_0", "another_day": "day"}
    )
    shares = {name: {**own, SHARE_OF_HIT: own[HITS] / 20.0} for name, own in found.items()}
    beside = {"day": shares["cell_0"], "MOB": shares["cell_1"]}
    effects = effects_of(found, CELLS, TORQUE, STATISTICS)
    cells = {**CELLS, "day": CELLS["cell_0"]}
    robots = ["robot_1", "robot_2", "robot_3"]
    table = table_of(trial, robots, {**shares, **beside}, cells, TORQUE, effects, STATISTICS)
    write_table(tmp_path / "out", table)
    rows = read_texts(tmp_path / "out.csv")
    for name, own in shares.items():
        held = {(row["measure"], row["robot"]): row for row in rows if row["name"] == name}
        factors = CELLS[name]
        for measure, values in own.items():
            for robot, walks in zip(robots, values, strict=True):
                assert float(held[measure, robot]["value"]) == pytest.approx(walks.mean(), rel=1e-5)
            assert float(held[measure, ALL]["value"]) == pytest.approx(values.mean(), rel=1e-5)
            assert float(held[measure, ALL]["random_torque_nm"]) == TORQUE * factors.random_torque
            assert held[measure, ALL]["pushes"] == ("often" if factors.pushes else "none")
    parts = [row["part"] for row in rows]
    per_set = 3 * (len(robots) + 1)
    counts = {"training sets": len(CELLS) * per_set, "beside": 2 * per_set, "effects": len(effects)}
    assert {part: parts.count(part) for part in counts} == counts
    lines = (tmp_path / "out.md").read_text().splitlines()[2:]
    assert len(lines) == len(CELLS) + 2 + len(effects) // 2
    assert sum(line.startswith("| MOB-Net | ") for line in lines) == len(CELLS)
    assert sum(line.startswith("| MOB-Net, another day | 0 | none | varied | ") for line in lines) == 1
    # A ratio over all levels names none.
    assert sum("often" not in line and "none" not in line and "/ with pushes" in line for line in lines) == 5


@pytest.fixture
def robot_with_hits(
    settings: Settings, layout: JointLayout, tmp_path: Path, made_up: Callable[..., Recording]
) -> TaughtRobot:
    """A robot that walks twice, pushed at one joint alone; its observer shows a share of the push, and nothing else."""
    trial = settings.trials.factorial
    gain_hz = settings.observer.gain_hz
    column = layout.names.index(trial.joint)
    recordings: list[Path] = []
    residuals: list[Path] = []
    for seed in (1, 2):
        recording = made_up(seed, 2.0)
        push = np.zeros((2000, layout.nv))
        push[FIRST:LAST, column] = 40.0 * seed * np.sin(np.pi * (np.arange(LAST - FIRST) + 0.5) / (LAST - FIRST))
        pushed = (np.abs(push).max(axis=1, keepdims=True) > 0.0).astype(float)
        truth = replace(recording.truth, tau_ext=push, tau_push=push, pushed=pushed)
        recordings.append(tmp_path / f"recording{seed}")
        residuals.append(tmp_path / f"residual{seed}")
        write_recording(recordings[-1], replace(recording, truth=truth), layout)
        behind = low_pass(push, gain_hz, recording.rate_hz)
        both = np.concatenate([SHOWN * behind, behind], axis=1)
        note = {"rate_hz": recording.rate_hz, "gain_hz": gain_hz}
        write_array(residuals[-1], both, residual_columns(layout), note, recording.segments)
    tried: list[Tried] = []
    for method in trial.references:
        tried.append(Tried(method, method, {}, {method: Catalogue(settings).method(method)}, {}, None, 0))
    joints = layout.limb(trial.limb)
    level = settings.levels["all_uncertainty"]
    task = TriedTask(level, joints, tuple(tried), tuple(recordings), tuple(residuals))
    asked = scoring(settings, trial.hits, "robot_1")
    window = settings.evaluation.windows[trial.as_in]
    return TaughtRobot(task, task, asked.model_copy(update={"window": window}))


def test_hits_are_judged_at_their_joint_around_them_alone(robot_with_hits: TaughtRobot, settings: Settings) -> None:
    trial = settings.trials.factorial
    known = settings.robot, settings.plant.gravity_m_s2, settings.observer
    walks = read_walks(*known, robot_with_hits.hits, 1000.0)
    place = walks.joints.index(trial.joint)
    window = robot_with_hits.asked.window
    assert window is not None
    around = slice(FIRST, LAST + round(1000.0 * window.after_s))
    whole = [float(np.sqrt(np.mean(truth[:, place] ** 2))) for truth in walks.truths]
    hit = [float(np.sqrt(np.mean(truth[around, place] ** 2))) for truth in walks.truths]
    missed = {"zero": 1.0, "MOB": 1.0 - SHOWN}
    peaks = settings.evaluation.peaks
    for tried in robot_with_hits.hits.tried:
        numbers = judged(trial.hits, trial.joint, robot_with_hits, tried, (walks, walks), peaks)
        share = missed[tried.name]
        assert numbers[WALKING] == pytest.approx(share * np.array(whole) / len(walks.joints), rel=1e-4)
        assert numbers[HITS] == pytest.approx(share * np.array(hit), rel=1e-3)
        assert numbers[SHARE_OF_HIT] == pytest.approx([1.0 - share] * 2, abs=1e-4)
        # nothing is as smooth as zero, and the observer's estimate is its residual
        assert numbers[ROUGHNESS] == pytest.approx([1.0 if tried.name == "MOB" else 0.0] * 2, abs=1e-6)
