"""The scenes of the page on which a reader plays with pushes: what is read of recordings and estimates."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import read_pair
from experiments.evaluation.compare.windows import FLAG, flagged_spans
from experiments.evaluation.measure.push_scene import PushRows, PushScene, read_push
from experiments.plan.parts import PageScene
from experiments.settings.pages import Explore, Story
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.columns import FEET, PUSH, PUSHED
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.detection.detector import LegGate
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.robot.description import RobotDescription
from mobnet.settings.detection import Detection

FORCES = [f"wrench_{foot}.force_{axis}" for foot, axis in product(FEET, "xyz")]

JUMP_M = 0.2  # between two poses, more than a robot walks


@dataclass(frozen=True)
class PagePush:
    """A push of the page, and the robot in P poses meanwhile.

    Attributes:
        scene: what the configuration says of it.
        name: that of the push.
        push: what is shown; its samples before `settled` are stored but not shown.
        poses: generalized positions (P, nq).
        wrenches: forces on both feet, axes of the foot (P, 6) [N].
        force: force of the push, world axes (P, 3) [N].
    """

    scene: PageScene
    name: str
    push: PushScene
    poses: NDArray[Any]
    wrenches: NDArray[Any]
    force: NDArray[Any]


def read_scene(
    scene: PageScene, settings: Explore, story: Story, detection: Detection, robot: RobotDescription
) -> PagePush | None:
    """Read a scene; None where its recording has no such push.

    Raises:
        DataError: a file is missing or damaged, or some method does not estimate the joint that is shown first.
    """
    recording = scene.runs[0].recording
    arrows, meta = read_array(recording, [PUSHED, f"{PUSH}.row"])
    rate = float(meta["rate_hz"])
    lead = round(settings.lead_s * rate)
    before = round(story.before_s * rate)
    earliest = max(lead + before, round(scene.from_s * rate))
    found = find_push(scene, arrows, meta["segments"], earliest)
    if found is None:
        return None
    start, end, last = found
    shown = slice(start - before - lead, min(start + round(story.after_s * rate), last))
    push = read_push(scene.runs, robot.layout, scene.limbs, scene.joint, PushRows(shown, start, end, lead))
    watched = watched_rows(scene, detection, robot, len(arrows))[shown]
    every = round(rate / settings.pose_hz)
    wrenches = read_array(recording, FORCES)[0][shown][::every].astype(np.float64)
    return PagePush(
        scene,
        list(scene.pushes)[max(int(arrows[start, 1]) - 1, 0)],  # the torque on a joint has no row
        replace(push, flags={**push.flags, "watched": watched}),
        standing_poses(robot, push.q[::every]),
        wrenches,
        push.force[::every],
    )


def find_push(
    scene: PageScene, arrows: NDArray[Any], segments: Sequence[Sequence[int]], earliest: int
) -> tuple[int, int, int] | None:
    """Return start and end of the push that a scene shows, and the end of its segment [rows]; None if there is none.

    Columns of `arrows` (T, 2) are whether something pushes, and the row of the push.
    """
    wanted = None if scene.name is None else list(scene.pushes).index(scene.name) + 1
    for first, last in segments:
        for start, end in flagged_spans(arrows[:, 0] > FLAG, ((int(first), int(last)),), 0):
            # The flag begins with the sample in which a push does, of which half may be without a force yet.
            row = arrows[start : end + 1, 1].max()
            if start - int(first) >= earliest and wanted in (None, row):
                return start, end, int(last)
    return None


def watched_rows(scene: PageScene, detection: Detection, robot: RobotDescription, count: int) -> NDArray[np.bool_]:
    """Return whether the leg of a scene is watched in each of its recording's samples (T,); no leg always is."""
    layout = robot.layout
    limb = layout.limb_of[scene.joint]
    if limb not in layout.legs.values():
        return np.ones(count, dtype=bool)
    gating = next(run for run in scene.runs if run.method == scene.gate)
    pair = read_pair(gating, layout)
    read = read_sensed(scene.runs[0].recording, layout)
    gate = LegGate.of(as_plain(detection.gate, GateNumbers), robot, limb, read.rate_hz)
    return gate.watch(read, pair.estimate[:, pair.places(layout.limb(limb))]).watched


def standing_poses(robot: RobotDescription, q: Array) -> Array:
    """Return positions (P, nq) of a robot that begins over the origin and stands on its lower sole.

    The sensed position of the base drifts (docs/notes/observer.md) and jumps where the ground repeats itself.
    """
    poses = q.copy()
    steps = np.diff(poses[:, :2], axis=0, prepend=poses[:1, :2])
    poses[:, :2] = np.cumsum(np.where(np.abs(steps) < JUMP_M, steps, 0.0), axis=0)
    poses[:, 2] -= sole_heights(robot, poses)
    return poses


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
