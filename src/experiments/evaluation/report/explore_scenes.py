"""The scenes of the page on which a reader plays with pushes: what is read of recordings and estimates."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Pair, read_pair, read_std
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import FLAG, flagged_spans
from experiments.plan.scenes import PageScene
from experiments.settings.measures import Scoring
from experiments.settings.pages import Explore, Story
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.columns import FEET, PUSH, PUSHED, named, recording_columns
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.recording import read_sensed
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.detection.detector import LegGate
from mobnet.robot.description import RobotDescription
from mobnet.settings.detection import Detection

ARROWS = named(PUSH, ("row", "force_x", "force_y", "force_z"))
FORCES = [f"wrench_{foot}.force_{axis}" for foot, axis in product(FEET, "xyz")]

JUMP_M = 0.2  # between two poses, more than a robot walks


@dataclass(frozen=True)
class Shown:
    """A scene, T samples of n joints and P poses.

    Attributes:
        scene: what the configuration says of it.
        joints: names (n,).
        rate_hz: samples per second [Hz].
        gain_hz: gain of the observer behind which everything lies [1/s].
        first: row of the recording at which it begins.
        lead: samples that are stored but not shown.
        start: sample at which the push begins.
        end: sample after its last one.
        pushed: name of the push.
        truth: external torque behind the observer's low-pass (T, n) [N m].
        push: what pushes alone add to the external torque, without a low-pass (T, n) [N m].
        estimates: method -> external torque (T, n) [N m].
        stds: method -> standard deviation (T, n) [N m], where it predicts one.
        flags: `swing`, `watched`, `pushed` -> whether it holds (T,).
        poses: generalized positions (P, nq).
        wrenches: forces on both feet, axes of the foot (P, 6) [N].
        force: force of the push, world axes (P, 3) [N].
    """

    scene: PageScene
    joints: tuple[str, ...]
    rate_hz: float
    gain_hz: float
    first: int
    lead: int
    start: int
    end: int
    pushed: str
    truth: NDArray[Any]
    push: NDArray[Any]
    estimates: Mapping[str, NDArray[Any]]
    stds: Mapping[str, NDArray[Any]]
    flags: Mapping[str, NDArray[np.bool_]]
    poses: NDArray[Any]
    wrenches: NDArray[Any]
    force: NDArray[Any]


def read_scene(
    scene: PageScene, settings: Explore, story: Story, detection: Detection, robot: RobotDescription
) -> Shown | None:
    """Read a scene; None where its recording has no such push.

    Raises:
        DataError: a file is missing or damaged, or some method estimates none of the joints.
    """
    first = scene.runs[0]
    layout = robot.layout
    arrows, meta = read_array(first.recording, [PUSHED, *ARROWS])
    rate = float(meta["rate_hz"])
    gain_hz = float(read_array_note(file_of(first.residual, NOTE))["gain_hz"])
    lead, before, after, earliest = (
        round(time_s * rate) for time_s in (settings.lead_s, story.before_s, story.after_s, scene.from_s)
    )
    found = find_push(scene, arrows, meta["segments"], max(lead + before, earliest))
    if found is None:
        return None
    start, end, last = found
    rows = slice(start - before - lead, min(start + after, last))
    pairs = {run.method: read_pair(run, layout) for run in scene.runs}
    joints = shared_joints(scene, layout, pairs)
    stds = {run.method: read_std(run, joints) for run in scene.runs}
    flags = read_flags(scene, detection, robot, pairs, arrows[:, 0] > FLAG)
    poses, wrenches = read_poses(first.recording, robot, rows, round(rate / settings.pose_hz))
    truth = pairs[first.method]
    return Shown(
        scene, joints, rate, gain_hz, rows.start, lead, start - rows.start, end - rows.start,
        list(scene.pushes)[max(int(arrows[start, 1]) - 1, 0)],  # the torque on a joint has no row
        truth=truth.truth[rows][:, truth.places(joints)],
        push=Scene(first.recording, layout, Scoring()).pushes[rows][:, layout.columns(joints)],
        estimates={name: pair.estimate[rows][:, pair.places(joints)] for name, pair in pairs.items()},
        stds={name: std[rows] for name, std in stds.items() if std is not None},
        flags={name: flag[rows] for name, flag in flags.items()},
        poses=poses, wrenches=wrenches,
        force=arrows[rows][:: round(rate / settings.pose_hz), 2:],
    )  # fmt: skip


def find_push(
    scene: PageScene, arrows: NDArray[Any], segments: Sequence[Sequence[int]], earliest: int
) -> tuple[int, int, int] | None:
    """Return start and end of the push that a scene shows, and the end of its segment [rows]; None if there is none.

    Columns of `arrows` (T, 5) are whether something pushes, the row of the push and its force.
    """
    wanted = None if scene.name is None else list(scene.pushes).index(scene.name) + 1
    for first, last in segments:
        for start, end in flagged_spans(arrows[:, 0] > FLAG, ((int(first), int(last)),), 0):
            # The flag begins with the sample in which a push does, of which half may be without a force yet.
            row = arrows[start : end + 1, 1].max()
            if start - int(first) >= earliest and wanted in (None, row):
                return start, end, int(last)
    return None


def shared_joints(scene: PageScene, layout: JointLayout, pairs: Mapping[str, Pair]) -> tuple[str, ...]:
    """Return the joints of the scene's limbs that every method estimates.

    Raises:
        DataError: there is none, or the one that is shown first is not among them.
    """
    found: list[str] = []
    for joint in layout.limbs(scene.limbs):
        if all(joint in pair.joints for pair in pairs.values()):
            found.append(joint)
    joints = tuple(found)
    if scene.joint not in joints:
        raise DataError(f"{scene.runs[0].recording}: {not_accepted('joint of the scene', scene.joint, joints)}")
    return joints


def read_flags(
    scene: PageScene, detection: Detection, robot: RobotDescription, pairs: Mapping[str, Pair],
    pushed: NDArray[np.bool_],
) -> dict[str, NDArray[np.bool_]]:  # fmt: skip
    """Return whether the leg swings by the plan, whether it is watched, and whether something pushes (T,).

    A joint of no leg has no swing, and is watched all the time.
    """
    recording = scene.runs[0].recording
    layout = robot.layout
    limb = next((leg for leg in layout.legs.values() if scene.joint in layout.limb(leg)), None)
    if limb is None:
        return {"swing": np.zeros_like(pushed), "watched": np.ones_like(pushed), "pushed": pushed}
    gating = pairs[detection.gate.method]
    read = read_sensed(recording, layout)
    gate = LegGate.of(detection.gate, robot, limb, read.rate_hz)
    watched = gate.watch(read, gating.estimate[:, gating.places(layout.limb(limb))]).watched
    return {"swing": read.sensed.swing[:, gate.foot] > FLAG, "watched": watched, "pushed": pushed}


def read_poses(recording: Path, robot: RobotDescription, rows: slice, every: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return every so many positions of some rows (P, nq), and the forces on both feet, axes of the foot (P, 6) [N].

    The robot begins over the origin, and stands on its lower sole: the sensed position of the base drifts (note 0007)
    and jumps where the ground repeats itself.
    """
    names = [name for name, *_ in recording_columns(robot.layout)["q"]]
    moved = read_array(recording, [*names, *FORCES])[0][rows][::every].astype(np.float64)
    poses = moved[:, : len(names)]
    forces = moved[:, len(names) :]
    steps = np.diff(poses[:, :2], axis=0, prepend=poses[:1, :2])
    poses[:, :2] = np.cumsum(np.where(np.abs(steps) < JUMP_M, steps, 0.0), axis=0)
    poses[:, 2] -= sole_heights(robot, poses)
    return poses, forces


def sole_heights(robot: RobotDescription, poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the height of the lowest corner of both soles at positions (P, nq), (P,) [m]; zero of a robot without."""
    found = np.zeros(len(poses))
    if robot.sole is None:
        return found
    tree = tree_of(robot, 1.0)
    still = np.zeros(robot.layout.nv)
    pose = empty_pose(tree)
    names = [body.name for body in robot.bodies]
    feet = [names.index(foot.body) for foot in robot.feet.values()]
    signs = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T
    corners = np.asarray(robot.sole.box_centre) + signs * np.asarray(robot.sole.box_half)
    for k, q in enumerate(np.ascontiguousarray(poses)):
        update(tree, q, still, 0.0, pose)
        found[k] = min(float((corners @ pose.rotation[b, 2] + pose.position[b, 2]).min()) for b in feet)
    return found
