"""The page on which a reader plays with pushes: one HTML file that needs no other, drawn from the data in it.

It has what `explore_scenes` reads, packed as `explore_pack` says, and the numbers of `explore_numbers` as a table, all
of which a browser shows that cannot unpack the data. The address holds what is shown.
"""

import base64
import gzip
import json
import logging
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.measure.push_scene import PushScene, story_push
from experiments.evaluation.report.explore_numbers import PushNumbers, push_numbers, stretches
from experiments.evaluation.report.explore_scenes import PagePush, read_scene
from experiments.evaluation.report.html import rendered
from experiments.plan.parts import PageScene
from experiments.settings.measures import Peaks
from experiments.settings.pages import Explore, Story
from mobnet.core.detections import COLLISION
from mobnet.core.errors import DataError
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.settings.detection import Detection

LARGEST = 2**15 - 1  # of a whole number of 16 bits
OBSERVER = "MOB"
STORY = "story"
NETWORK, DIRECT, FORMULA = "network", "direct", "formula"
ROLES = {OBSERVER: "observer", "MOB-Net": NETWORK, "FTS-e2e": DIRECT}  # method -> its colour; others are formulas
PUSHED = "-pushed"  # ends the name of a method with other training data
SIDES = {"L": ("left",), "R": ("right",)}  # first letter of a joint's name in the source of the table -> word
FLAGS = ("swing", "watched", "pushed")
STEP_M, STEP_N = 1e-4, 0.1  # of positions [m, rad, -] and forces [N]
log = logging.getLogger(__name__)


# A page unpacks them with the `DecompressionStream` that browsers have. Differences of neighbouring samples are small,
# so that their upper bytes are nearly all alike, and are packed together.
@dataclass(frozen=True)
class PackedArray:
    """An array (T, n) of a page: its name, and the step of its whole numbers in its own unit."""

    name: str
    step: float
    values: NDArray[Any]

    @property
    def place(self) -> dict[str, Any]:
        """What a page must know to unpack it."""
        return {"name": self.name, "step": self.step, "count": len(self.values), "width": self.values.shape[1]}


def packed(parts: Iterable[PackedArray]) -> str:
    """Return arrays one after the other as text, the same for equal ones.

    Raises:
        DataError: a value is more than 32767 steps.
    """
    return base64.b64encode(gzip.compress(b"".join(map(_planes, parts)), 9, mtime=0)).decode()


def _planes(part: PackedArray) -> bytes:
    """Return an array column by column as differences, first all their lower and then all their upper bytes."""
    whole = np.round(np.asarray(part.values, dtype=np.float64) / part.step).T
    if whole.size and np.abs(whole).max() > LARGEST:
        largest = float(np.abs(part.values).max())
        raise DataError(f"{part.name}: {largest:g} is not accepted; accepted: up to {LARGEST * part.step:g}")
    # A difference may exceed 16 bits; it wraps around, and so does its sum.
    steps = np.diff(whole.astype(np.int64), axis=1, prepend=0).astype("<u2", casting="unsafe")
    return np.ascontiguousarray(steps).view(np.uint8).reshape(-1, 2).T.tobytes()


def explore(
    settings: Explore,
    story: Story,
    detection: Detection,
    peaks: Peaks,
    robot: RobotTable,
    looks: Looks | None,
    scenes: Mapping[str, PageScene],
    collisions: Path,
    detected: Path,
    templates: Sequence[Path],
    out: Path,
) -> None:
    """Write the page; a scene whose recording has no such push is left out.

    `templates` has the page's HTML, then the files that it includes; `collisions` are those of the story's robot and
    `detected` what its detectors say of them.

    Raises:
        DataError: a file is missing or damaged, or no recording has a push that is shown.
    """
    description = describe(robot)
    read = {name: read_scene(scene, settings, story, detection, description) for name, scene in scenes.items()}
    shown = {name: scene for name, scene in read.items() if scene is not None}
    log.info("%s: %d of %d scenes", out, len(shown), len(scenes))
    if not shown:
        raise DataError(f"{out}: no recording has a push that the page shows; accepted: one or more")
    alarm: dict[str, Any] | None = None
    if STORY in shown:
        alarm = alarm_of(shown[STORY], story, description.layout, {"collisions": collisions, "detected": detected})
    seen = dressed(description, looks)
    write_text(out, page_of(shown, alarm, settings, story, detection, peaks, seen, templates[0]))


def page_of(
    shown: Mapping[str, PagePush],
    alarm: Mapping[str, Any] | None,
    settings: Explore,
    story: Story,
    detection: Detection,
    peaks: Peaks,
    robot: RobotDescription,
    template: Path,
) -> str:
    """Return the page of some scenes; `alarm` is that of the story's detector; scripts stand beside the template."""
    stored: dict[str, PushScene] = {}
    parts: list[PackedArray] = []
    for name, scene in shown.items():
        # The page computes with the rounded torques that it gets: the table has numbers of the same.
        stored[name] = as_stored(scene.push, settings.step_nm)
        parts += parts_of(scene, settings)
    scenes: dict[str, dict[str, Any]] = {}
    numbers: dict[str, list[PushNumbers]] = {}
    steps: dict[str, dict[str, PushNumbers]] = {}
    judged_s = judged_before_s(story)
    for name, scene in shown.items():
        note = scene_note(name, scene, robot, settings, alarm if name == STORY else None)
        scenes[name] = note
        numbers[name] = push_numbers(stored[name], note["joint"], note["threshold"], detection, peaks, judged_s)
        steps[name] = {row.method: row for row in numbers[name]}
    told = {
        "settings": page_numbers(settings, detection, peaks, story),
        "robot": robot_parts(robot),
        "scenes": list(scenes.values()),
    }
    return rendered(
        template,
        told=json.dumps(told, separators=(",", ":")),
        numbers=numbers,
        scenes=scenes,
        role_of=role_of,
        network=next((method for method in steps.get(STORY, {}) if role_of(method) == NETWORK), None),
        data=packed(parts),
        detection=detection,
        peaks=peaks,
        judged_s=judged_s,
        after_s=story.after_s,
        joint_names=joint_names(robot),
        alarm_of=story.detector,
        steps=steps,
        trained_hz=next(iter(stored.values())).gain_hz,
    )


def judged_before_s(story: Story) -> float:
    """Return how long before a push errors around it begin [s]: as long as those of the demo, which must settle."""
    return story.before_s - story.settle_s


def page_numbers(settings: Explore, detection: Detection, peaks: Peaks, story: Story) -> dict[str, Any]:
    """Return the numbers of the configuration with which the page computes."""
    return {
        "gains": settings.gains_hz,
        "thresholds": settings.thresholds_nm,
        "poseHz": settings.pose_hz,
        "lowPassHz": detection.low_pass_hz,
        "holdS": detection.hold_s,
        "lateS": detection.late_s,
        "afterS": peaks.after_s,
        "longestS": peaks.longest_s,
        "judgedS": judged_before_s(story),
    }


def robot_parts(robot: RobotDescription) -> dict[str, Any]:
    """Return bodies, joints, solids with their colours, and soles of a robot, bodies by their number."""
    index = {body.name: k for k, body in enumerate(robot.bodies)}
    limbs = robot.layout.limb_of
    tones: dict[str, list[int]] = {}
    for name, colour in robot.tones.items():
        tones[name] = [round(255 * part) for part in colour[:3]]
    sole = robot.sole
    return {
        "bodies": [[index.get(body.parent, -1), body.pos, body.quat] for body in robot.bodies],
        "joints": [[joint.id, index[joint.body], joint.axis, limbs.get(joint.id, "")] for joint in robot.joints],
        "shapes": [
            [index[shape.body], shape.type, shape.size, shape.segment or shape.pos, shape.tone]
            for shape in robot.shapes
        ],
        "tones": tones,
        "feet": [index[foot.body] for foot in robot.feet.values()],
        "sole": [sole.box_centre, sole.box_half] if sole else None,
    }


def joint_names(robot: RobotDescription) -> dict[str, str]:
    """Return joint -> what a reader calls it, by its name in the source of the table."""
    found: dict[str, str] = {}
    for joint in robot.joints:
        side, _, rest = (joint.name or joint.id).removesuffix("_Joint").rpartition("_")
        words = re.sub(r"([A-Z]|\d+)", r" \1", rest).lower().split()
        found[joint.id] = " ".join([*SIDES.get(side, ()), *words])
    return found


def scene_note(
    name: str, shown: PagePush, robot: RobotDescription, settings: Explore, alarm: Mapping[str, Any] | None
) -> dict[str, Any]:
    """Return what the page must know of a scene besides its arrays."""
    scene = shown.scene
    push = shown.push
    row = scene.pushes[shown.name]
    names = joint_names(robot)
    bodies = [body.name for body in robot.bodies]
    point = next((point for point in robot.points if point.name == row.point), None)
    return {
        "name": name,
        "push": scene.push,
        "plant": scene.plant,
        "joint": scene.joint,
        "threshold": scene.threshold_nm,
        "joints": [[joint, names[joint]] for joint in push.joints],
        "methods": [[method, role_of(method)] for method in push.estimates],
        "stds": list(push.stds),
        "rate": push.rate_hz,
        "gain": push.gain_hz,
        "lead": push.settled,
        "start": push.start,
        "end": push.end,
        "count": len(push.truth),
        "point": [bodies.index(point.body), point.pos, point.name.replace("_", " ")] if point else None,
        "turned": row.joint,
        "flags": {key: list(stretches(push.flags[key])) for key in FLAGS},
        "alarm": alarm,
        "parts": [part.place for part in parts_of(shown, settings)],
    }


def parts_of(shown: PagePush, settings: Explore) -> Iterator[PackedArray]:
    """Yield the arrays of a scene, of the residual's methods what they subtract from it, which is smoother."""
    push = shown.push
    step = settings.step_nm
    yield PackedArray("poses", STEP_M, shown.poses)
    yield PackedArray("wrenches", STEP_N, shown.wrenches)
    yield PackedArray("force", STEP_N, shown.force)
    yield PackedArray("truth", step, push.truth)
    yield PackedArray("push", step, push.push)
    for method, estimate in push.estimates.items():
        values = estimate if is_whole(push.estimates, method) else push.estimates[OBSERVER] - estimate
        yield PackedArray(method, step, values)
    for method, std in push.stds.items():
        yield PackedArray(f"std {method}", step, std)


def is_whole(methods: Collection[str], method: str) -> bool:
    """Return whether a page stores a method's torque, and not what the method subtracts from the observer's."""
    return OBSERVER not in methods or role_of(method) in (ROLES[OBSERVER], DIRECT)


def role_of(method: str) -> str:
    """Return what a method is, which gives it its colour."""
    return ROLES.get(method.removesuffix(PUSHED), FORMULA)


def as_stored(shown: PushScene, step_nm: float) -> PushScene:
    """Return a scene with the torques that a page gets of it, whole numbers of steps [N m]: its numbers are theirs."""

    def stored(values: NDArray[Any]) -> NDArray[np.float64]:
        return np.round(np.asarray(values, dtype=np.float64) / step_nm) * step_nm

    def rebuilt(method: str, torque: NDArray[Any]) -> NDArray[np.float64]:
        if is_whole(shown.estimates, method):
            return stored(torque)
        # The page gets what the method subtracts from the residual, which is smoother.
        residual = shown.estimates[OBSERVER]
        return stored(residual) - stored(residual - torque)

    estimates = {method: rebuilt(method, torque) for method, torque in shown.estimates.items()}
    return replace(shown, truth=stored(shown.truth), push=stored(shown.push), estimates=estimates)


def alarm_of(shown: PagePush, story: Story, layout: JointLayout, files: Mapping[str, Path]) -> dict[str, Any] | None:
    """Return when the story's detector finds its push and what it names, as recorded; None if it does not find it.

    Its thresholds are those for one false alarm an hour; the files are those of the robot's detectors.
    """
    hit, alarm = story_push(story, files, shown.scene.runs[0].test_seed, COLLISION)
    if alarm is None:
        return None
    push = shown.push
    side = next(side for side, limb in layout.legs.items() if limb == hit.leg)
    named = f"{side} {alarm.link}, {alarm.direction}"
    return {"detector": story.detector, "at": push.start + round(alarm.delay_s * push.rate_hz), "named": named}
