"""A made-up scene of the page on which a reader plays with pushes: a push, friction, and four methods."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.measure.push_scene import PushScene
from experiments.evaluation.report.explore_scenes import PagePush
from experiments.plan.parts import PageScene
from experiments.plan.runs import Run
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Push

RATE_HZ, GAIN_HZ, POSE_HZ = 1000.0, 100.0, 100.0
LEAD, START, LENGTH, ROWS = 500, 2200, 80, 4500
SWINGS = ((700, 1250), (2100, 2650), (3500, 4050))
METHODS = ("MOB", "MOB-fric-dahl", "MOB-Net-pushed", "FTS-e2e")


def pushed_scene(robot: RobotDescription, seed: int = 0, push: str = "Knee, in the air", plant: str = "a") -> PagePush:
    """Return a scene in which the left knee is hit in the second of three swings; friction errs by 40 N m."""
    rng, joints, rows = np.random.default_rng(seed), robot.layout.limb("LL"), np.arange(ROWS)
    shape = np.where((rows >= START) & (rows < START + LENGTH), np.sin(np.pi * (rows - START) / LENGTH), 0.0)
    swing = flagged(SWINGS)
    raw = np.outer(shape, np.linspace(10.0, 60.0, len(joints))) + np.where(swing, 0.0, 50.0)[:, None]
    friction = 40.0 * np.sign(np.sin(2 * np.pi * rows / 700.0))[:, None] + 4.0 * rng.normal(size=raw.shape)
    hit = raw - np.where(swing, 0.0, 50.0)[:, None]
    truth, pushed = (low_pass(signal, GAIN_HZ, RATE_HZ) for signal in (raw, hit))
    residual = low_pass(raw + friction, GAIN_HZ, RATE_HZ)
    shares = {"MOB": 0.0, "MOB-fric-dahl": 0.9, "MOB-Net-pushed": 0.95}
    estimates = {name: residual - share * (residual - truth) for name, share in shares.items()}
    estimates["FTS-e2e"] = truth - 0.6 * pushed
    watched = flagged([(start + 90, end - 30) for start, end in SWINGS])
    run = Run("collisions", "robot_1", "MOB", 101, 240, Path("recording"), Path("residual"), Path("estimate"))
    row = Push(point="left_knee_front", duration_s=(0.08, 0.08), force_n=(100.0, 100.0), shape="half_sine")
    scene = PageScene(push, plant, (run,), ("LL",), "LL3", 20.0, "MOB-Net-pushed", {"collision_left_knee_front": row})
    force = np.outer(shape[:: round(RATE_HZ / POSE_HZ)], [-150.0, 0.0, 80.0])
    shown = PushScene(
        joints=joints,
        rate_hz=RATE_HZ,
        gain_hz=GAIN_HZ,
        first=0,
        settled=LEAD,
        start=START,
        end=START + LENGTH,
        truth=truth,
        push=hit,
        estimates=estimates,
        stds={"MOB-Net-pushed": np.full(truth.shape, 3.0)},
        flags={"swing": swing, "watched": watched, "pushed": flagged([(START, START + LENGTH)])},
        q=np.zeros((ROWS, robot.layout.nq)),
        force=np.outer(shape, [-150.0, 0.0, 80.0]),
    )
    wrenches = np.tile([0.0, 0.0, 500.0], (450, 2))
    return PagePush(scene, "collision_left_knee_front", shown, poses(robot), wrenches, force)


def flagged(spans: object) -> NDArray[np.bool_]:
    """Return where some spans of rows are, (ROWS,)."""
    found = np.zeros(ROWS, dtype=bool)
    for start, end in spans:  # type: ignore[attr-defined]
        found[start:end] = True
    return found


def poses(robot: RobotDescription) -> NDArray[np.float64]:
    """Return positions in which every joint moves, and the base turns and walks, (450, nq)."""
    time = np.arange(450) / POSE_HZ
    q = np.zeros((450, robot.layout.nq))
    q[:, 0], q[:, 2], q[:, 3], q[:, 6] = 0.3 * time, 0.95, np.cos(0.2 + 0.05 * time), np.sin(0.2 + 0.05 * time)
    q[:, 7:] = 0.3 * np.sin(time[:, None] + np.arange(robot.layout.nu))
    return q
