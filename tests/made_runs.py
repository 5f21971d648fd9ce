"""Made-up recordings with residuals and estimates, whose steps and errors are known."""

from pathlib import Path

import numpy as np
from made_scores import JOINTS

from experiments.plan.runs import Run
from mobnet.core.columns import FEET, residual_columns, torque_columns
from mobnet.core.joints import N_VIRTUAL, NQ_BASE, JointLayout
from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array

RATE_HZ = 100.0
STEP_ROWS = 70  # rows in the air and rows on the ground of the made-up walk
PUSHED_ROWS = range(20, 30)  # of every swing of the made-up walk


def write_walk(
    folder: Path, layout: JointLayout, error: float, steps: int, method: str, joints: list[str], std: float | None,
    calm: bool,
) -> Run:  # fmt: skip
    """Write recording, residual and estimate of a made-up walk of some gait cycles, pushed in every swing unless calm.

    Of every joint the estimate has a constant error and a standard deviation, or none; that of the residual is 5 [N m].
    """
    rows = 2 * STEP_ROWS * steps
    phase = np.arange(rows) % (2 * STEP_ROWS)
    air = (phase < STEP_ROWS).astype(float)
    load = np.where(air > 0, 0.0, 60.0 * np.sin(np.pi * (phase - STEP_ROWS) / STEP_ROWS))
    truth = load[:, None] * np.linspace(-1, 1, layout.nv)
    zeros = np.zeros
    q, acc = np.tile(np.eye(1, layout.nq, 3), (rows, 1)), np.tile([0.0, 0.0, 9.81], (rows, 1))
    sensed = Sensed(q, zeros((rows, layout.nv)), acc, zeros((rows, layout.nu)),
                    zeros((rows, layout.nu)), np.stack([air, 1 - air], axis=1), zeros((rows, 5)),
                    zeros((rows, 2)))  # fmt: skip
    wrench, pushed = zeros((rows, 6)), (np.isin(phase, PUSHED_ROWS) & (not calm)).astype(float)[:, None]
    push = zeros((rows, layout.nv))
    unseen = Truth(truth, wrench, wrench, zeros((rows, 2)), pushed, zeros((rows, layout.nu)), push, zeros((rows, 4)))
    recording = Recording(sensed, ((0, rows),), RATE_HZ, {}, unseen)
    write_recording(folder / "recording", recording, layout)
    written = np.concatenate([truth + 5, truth], axis=1)
    write_array(folder / "residual", written, residual_columns(layout), {"rate_hz": RATE_HZ})
    columns = torque_columns(layout, ["tau_ext"], joints)
    estimate = truth[:, layout.columns(joints)] + error
    if std is not None:
        columns += torque_columns(layout, ["std"], joints)
        estimate = np.concatenate([estimate, np.full(estimate.shape, std)], axis=1)
    write_array(folder / "estimate", estimate, columns, {"rate_hz": RATE_HZ})
    return run_of(folder, method)


def run_of(folder: Path, method: str) -> Run:
    """Return the run of a method whose files stand in a folder."""
    stems = (folder / name for name in ("recording", "residual", "estimate"))
    return Run("forward_walk", "all_uncertainty", method, 0, 1, *stems)


def write_steps(stem: Path, layout: JointLayout, seed: int, size: float = 1.0, stands: bool = False) -> Path:
    """Write a recording of 20 s of random steps and motion, and its residual beside it; return the recording's stem.

    The residual's name ends in `_residual`. `size` is that of velocities [rad/s] and, times 40, of desired torques
    [N m]; a robot that stands does so in the second half.
    """
    rng, rows = np.random.default_rng(seed), 2000
    time = np.arange(rows) / RATE_HZ
    speed = 2 * np.pi * rng.uniform(0.2, 2.0, layout.nu)
    phase = speed * time[:, None] + rng.uniform(0, 6.3, layout.nu)
    q, v = np.zeros((rows, layout.nq)), np.zeros((rows, layout.nv))
    q[:, 3], q[:, NQ_BASE:] = 1.0, -size * (np.cos(phase) / speed)[:, ::-1]
    v[:, N_VIRTUAL:] = size * np.sin(phase)[:, ::-1]
    step = np.arange(rows) // STEP_ROWS
    low, high = np.array([-0.15, -0.1, -0.3, 0.6, 0.04]), np.array([0.2, 0.1, 0.3, 0.9, 0.07])
    command = rng.uniform(low, high, (step[-1] + 1, len(low)))[step]
    swing = np.stack([step % 2 == 0, step % 2 == 1], axis=1) & (np.arange(rows) % STEP_ROWS > 5)[:, None]
    if stands:
        command[rows // 2 :], swing[rows // 2 :] = 0.0, False
    torque = 40.0 * size * rng.normal(size=(rows, layout.nu))
    acc = rng.normal(size=(rows, 3)) + [0.0, 0.0, 9.81]
    sensed = Sensed(q, v, acc, torque, np.clip(torque, -25.0, 25.0), swing.astype(float), command, np.zeros((rows, 2)))
    wrench, pushed = np.zeros((rows, 6)), np.zeros((rows, 1))
    still, external = (np.zeros_like(torque), np.zeros_like(v), np.zeros((rows, 4))), rng.normal(size=v.shape)
    truth = Truth(external, wrench, wrench, 1.0 - swing, pushed, *still)
    meta = {"falls": seed % 2, "terrains": ["checks", "flat"]}
    spans = ((0, rows // 2), (rows // 2, rows))
    write_recording(stem, Recording(sensed, spans, RATE_HZ, meta, truth), layout)
    residual = np.concatenate([size * 20.0 * rng.normal(size=v.shape), truth.tau_ext], axis=1)
    beside = stem.with_name(f"{stem.name}_residual")
    write_array(beside, residual, residual_columns(layout), {"rate_hz": RATE_HZ}, spans)
    return stem


def write_predicted(folder: Path, layout: JointLayout, seed: int, scale: float | None) -> Run:
    """Write an estimate of the left leg whose errors have the spread that it predicts, ten times that around pushes.

    The recording has only the columns that show pushes. A scale is noted beside the standard deviations.
    """
    rng, rows = np.random.default_rng(seed), 2000
    air = (np.arange(rows) % (2 * STEP_ROWS) < STEP_ROWS).astype(float)
    pushed = np.isin(np.arange(rows) % (10 * STEP_ROWS), range(30, 40))
    columns = [(f"swing.{FEET[0]}", "-", "plan"), (f"contact.{FEET[0]}", "-", "ground"),
               ("tau_ext.LL3", "N m", "joint")]  # fmt: skip
    array = np.stack([air, 1.0 - air, 30.0 * pushed], axis=1)
    write_array(folder / "recording", array, columns, {"rate_hz": RATE_HZ})
    truth, std = 20.0 * rng.normal(size=(rows, layout.nv)), rng.uniform(0.5, 3.0, (rows, len(JOINTS)))
    write_array(folder / "residual", truth, torque_columns(layout, ["tau_ext_lp"], layout.names), {"rate_hz": RATE_HZ})
    near = np.convolve(pushed, np.ones(11))[:rows] > 0  # a push and the tenth of a second after it
    error = std * rng.normal(size=std.shape) * np.where(near, 10.0, 1.0)[:, None]
    columns = [(f"{kind}.{joint}", "N m", "joint") for kind in ("tau_ext", "std") for joint in JOINTS]
    meta = {"rate_hz": RATE_HZ} | ({} if scale is None else {"std_scale": dict.fromkeys(JOINTS, scale)})
    estimate = np.concatenate([truth[:, layout.columns(JOINTS)] + error, std], axis=1)
    write_array(folder / "estimate", estimate, columns, meta)
    return run_of(folder, "MOB-Net")
