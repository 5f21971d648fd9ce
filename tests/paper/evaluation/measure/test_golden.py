"""All measures of one made-up walk, as numbers that a change of any of them moves: behind the tables, which average."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from csv_files import check_golden
from made_swings import unseen

from experiments.evaluation.measure.estimates.scores import score
from experiments.plan.runs import Run
from experiments.settings.measures import Bode, Changed, Drift, Peaks, Phases, Scoring, Sigma
from experiments.settings.runs import HeldRuns, LearnedRuns, LegRuns, LimbRuns, PushedLimbRuns, PushWindow
from mobnet.core.columns import residual_columns, torque_columns
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording, Sensed
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.kernel.low_pass import low_pass

RATE_HZ, GAIN_HZ, ROWS = 200.0, 100.0, 1600
SEGMENTS = ((0, 900), (900, ROWS))
STEP_ROWS, SWING_ROWS, TOUCHED_ROWS = 160, 70, 20  # of a step, of its swing, and before its end on the ground too early
PUSHES = ((230, 280), (700, 1020), (1300, 1316))  # the second one is cut by the end of a segment
RUN = {"scenario": "knee_swing", "level": "all_uncertainty", "methods": ("MOB-Net",)}
LINE_HZ = 4.0
LEG = {**RUN, "limbs": ("LL",)}
SECTIONS = (
    Bode(**RUN, limb="LL", shown=("LL4",), bands_hz=(LINE_HZ,)),
    Changed(window_s=1.0, lift_off_s=0.05, landing_s=0.05, least_share=0.4, tests={"a": LegRuns(**LEG)}),
    Drift(limb="LL", steps=2, calm_s=0.2, tests={"a": HeldRuns(**RUN)}),
    Peaks(turned_share=0.3, before_s=0.05, after_s=0.1, longest_s=0.5, tests=(PushedLimbRuns(**LEG),)),
    Phases(touch_down_s=0.05, tests=(LimbRuns(**LEG),)),
    Sigma(parts=2, lags_ms=(5, 50, 500), longest_s=1.0, tests={"a": LearnedRuns(**LEG)}, against={}),
)
ASKED = Scoring(
    window=PushWindow(before_s=0.05, after_s=0.1),
    sections={type(section).__name__.lower(): section for section in SECTIONS},  # a module has its section's name
    touch_down_s=0.05,
    stuck_rad_s=0.05,
    cover_share=0.9,
    lines={"LL4": (LINE_HZ,)},
)


def by_segment(signal: np.ndarray) -> np.ndarray:
    """Return a signal (T, n) behind the observer's low-pass, each segment from rest."""
    return np.concatenate([low_pass(signal[start:end], GAIN_HZ, RATE_HZ) for start, end in SEGMENTS])


def waves(count: int, first_hz: float, phase: float) -> np.ndarray:
    """Return sines (ROWS, count) of frequencies that rise from column to column."""
    time = np.arange(ROWS)[:, None] / RATE_HZ
    return np.sin(2.0 * np.pi * (first_hz + 0.17 * np.arange(count)) * time + phase)


def write_run(folder: Path, layout: JointLayout) -> Run:
    """Write a walk with three pushes, what the observer makes of it, and an estimate of a leg in closed form."""
    leg = layout.limb("LL")
    columns = layout.columns(leg)
    step = np.arange(ROWS) % STEP_ROWS
    swing = step < SWING_ROWS
    pushed, push = np.zeros(ROWS, dtype=bool), np.zeros((ROWS, layout.nv))
    for start, end in PUSHES:
        rows = np.arange(end - start)
        pushed[start:end] = True
        shape = np.sin(np.pi * (rows + 0.5) / len(rows)) + 0.2 * np.sin(2.0 * np.pi * LINE_HZ * rows / RATE_HZ)
        push[start:end, columns] = np.outer(shape, [1.0, 4.0, 15.0, 30.0, 9.0, 0.0])
    external = push + 20.0 * waves(layout.nv, 0.3, 0.2) * (1.0 - swing[:, None])
    flags, feet = np.zeros((ROWS, 2)), np.zeros((ROWS, 2))
    flags[:, 0] = swing
    feet[:, 0] = step >= SWING_ROWS - TOUCHED_ROWS
    truth = replace(
        unseen(layout, ROWS), tau_ext=external, tau_push=push, pushed=pushed[:, None].astype(float), contact=feet
    )
    q, v = np.zeros((ROWS, layout.nq)), np.zeros((ROWS, layout.nv))
    q[:, 3] = 1.0
    v[:, -layout.nu :] = 0.2 * waves(layout.nu, 0.5, 1.0)
    none = np.zeros((ROWS, layout.nu))
    sensed = Sensed(q, v, np.zeros((ROWS, 3)), none, none, flags, np.zeros((ROWS, 5)), np.zeros((ROWS, 2)))
    stems = folder / "recording", folder / "residual", folder / "estimate"
    write_recording(stems[0], Recording(sensed, SEGMENTS, RATE_HZ, {}, truth), layout)
    meta = {"rate_hz": RATE_HZ, "gain_hz": GAIN_HZ}
    behind, label = by_segment(external), by_segment(external + 0.5 * waves(layout.nv, 0.9, 0.4))
    uncertainty = 5.0 * waves(layout.nv, 0.7, 0.0)
    signals = np.concatenate([behind + uncertainty, behind, label], axis=1)
    write_array(stems[1], signals, residual_columns(layout, labelled=True), meta, SEGMENTS)
    shown = np.roll(by_segment(push), 2, axis=0)[:, columns]  # two rows late
    missed = 0.25 * shown + (shown - by_segment(push)[:, columns])
    error = waves(len(leg), 1.3, 0.7) * np.arange(1, len(leg) + 1) + 0.3 * waves(len(leg), 11.0, 0.0) - missed
    std = 1.0 + 0.5 * np.arange(len(leg)) + 0.4 * waves(len(leg), 0.2, 0.0)
    held = np.concatenate([behind[:, columns] + error, std], axis=1)
    write_array(stems[2], held, torque_columns(layout, ["tau_ext", "std"], leg), meta, SEGMENTS)
    return Run("knee_swing", "all_uncertainty", "MOB-Net", 0, 1, *stems)


def test_scores_of_a_made_up_walk_are_the_golden_ones(tmp_path: Path, layout: JointLayout) -> None:
    score(layout, [write_run(tmp_path, layout)], ASKED, tmp_path / "measures.csv")
    check_golden(tmp_path / "measures.csv")
