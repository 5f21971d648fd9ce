"""The film of one push: the robot that is pushed, and beside it the torque that is true and that methods estimate."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from experiments.evaluation.compare.curves import TRUTH, TorqueCurve
from experiments.evaluation.figures.drawing.push_frame import Moment, TorquePlot, draw_frame
from experiments.evaluation.figures.drawing.pushed import standing
from experiments.evaluation.figures.drawing.robot import projection
from experiments.evaluation.measure.estimates.felt import PushResponse
from experiments.evaluation.measure.push_scene import PushScene, read_story
from experiments.evaluation.number.rows import write_csv
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.records.collisions import Collision
from experiments.settings.measures import Peaks
from experiments.settings.pages import PushFilm, Story
from mobnet.core.arrays import Array
from mobnet.core.files import atomic_path
from mobnet.core.joints import JointLayout
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.simulation.render import Pixels

NEAR_WHITE = 251  # of 255
EFFORT = {"quality": 50, "method": 3}  # of WebP without loss: more takes longer and saves nothing
COLUMNS = ("method", "joint", "peak_share", "delay_ms", "rmse_nm")
HEADS = ("", "share of the peak", "delay", "RMSE")
EASED = 8  # frames in which the time axis takes another width
ROOM = 0.06  # above and below the curves, share of their range
MS = 1000.0
Ends = tuple[float, float]


def save_still(frame: Pixels, path: Path) -> None:
    """Write one frame (height, width, 3) as a PNG, as a whole or not at all."""
    with atomic_path(path) as temporary:
        Image.fromarray(frame).save(temporary, "png", optimize=True)


def palette_of(frame: Pixels, colours: int) -> Image.Image:
    """Return an image with a palette of the main colours of a frame (height, width, 3); almost white is white."""
    image = Image.fromarray(frame).quantize(colours)
    palette = np.reshape(image.getpalette() or [], (-1, 3))
    palette[palette.min(axis=1) >= NEAR_WHITE] = 255
    image.putpalette(palette.ravel().tolist())
    return image


def save_drawing(frames: Sequence[Pixels], seen_s: Sequence[float], palette: Image.Image, out: Path) -> None:
    """Write frames (height, width, 3), each seen for a time [s], as a WebP and a GIF that repeat.

    Drawings have few colours: with those of a palette, WebP without loss is smaller than with it, and text is sharp.
    """
    flat = [Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    duration = [round(MS * time_s) for time_s in seen_s]
    _save([image.convert("RGB") for image in flat], out.with_suffix(".webp"), duration, lossless=True, **EFFORT)
    _save(flat, out.with_suffix(".gif"), duration)


def _save(images: Sequence[Image.Image], path: Path, duration: Sequence[int], **options: int) -> None:
    """Write images with their durations [ms] in the format of the path's ending."""
    with atomic_path(path) as temporary:
        first, *others = images
        kind = path.suffix.removeprefix(".")
        first.save(temporary, kind, save_all=True, append_images=others, duration=list(duration), loop=0, **options)


@dataclass(frozen=True)
class Shot:
    """A frame: a time from the beginning of the push on [s], how long it is seen [s], and what is shown then.

    Attributes:
        time_s: of the walk.
        seen_s: on the screen.
        ends_s: of the time axis.
        slowed: whether time runs slower.
        told: whether the numbers are shown.
    """

    time_s: float
    seen_s: float
    ends_s: Ends
    slowed: bool
    told: bool


def push_film(
    settings: PushFilm,
    story: Story,
    peaks: Peaks,
    robot: RobotTable,
    looks: Looks | None,
    layout: JointLayout,
    runs: Sequence[Run],
    detections: Detections,
    out: Path,
) -> None:
    """Write the film of the push of a story from the files of a run, as `draw_film` does."""
    hit, push = read_story(story, layout, runs, detections[story.level], settings.kind)
    draw_film(settings, story, peaks, robot, looks, layout, hit, push, out)


def draw_film(
    settings: PushFilm,
    story: Story,
    peaks: Peaks,
    robot: RobotTable,
    looks: Looks | None,
    layout: JointLayout,
    hit: Collision,
    push: PushScene,
    out: Path,
) -> None:
    """Write a film as WebP and GIF, a still of it as PNG, and the numbers in it as CSV, beside each other.

    The film begins with the still: what shows its first frame alone, such as a mail, shows the answer.
    """
    joint = story.joint
    torques = push.torques(joint)
    felt = {method: push.felt(torque, joint, peaks) for method, torque in torques.items()}
    errors_nm = {method: push.error_nm(torque, joint) for method, torque in torques.items()}
    rows = [(method, joint, response.share, response.delay_ms, errors_nm[method]) for method, response in felt.items()]
    write_csv(out.with_suffix(".csv"), COLUMNS, rows)
    course = course_of(settings, push, joint)
    stage = _Stage(settings, dressed(describe(robot), looks), layout, hit, push, course, lines_of(felt, errors_nm))
    shots = shots_of(settings, story)
    still = stage.still()
    frames = [still, *(stage.frame(shot) for shot in shots)]
    seen_s = [settings.answer_s, *(shot.seen_s for shot in shots)]
    save_still(still, out.with_suffix(".png"))
    save_drawing(frames, seen_s, palette_of(still, settings.colours), out)


def shots_of(settings: PushFilm, story: Story) -> list[Shot]:
    """Return the frames of the film after its first one, in order: real time, slower, a still, and real time again.

    The time axis shows what was and what is slowed; what is slowed alone; and that with what follows.
    """
    (slow_s, usual_s) = settings.slow_s
    step_s = 1.0 / settings.frames_hz
    slowed_s = 1.0 / settings.slowed_hz
    first = (-story.before_s, usual_s)
    near = near_of(settings)
    last = (near_of(settings)[0], story.after_s)
    before = np.arange(first[0], slow_s, step_s)
    slowed = np.arange(slow_s, usual_s, slowed_s / settings.slower)
    after = np.arange(usual_s + step_s, story.after_s, step_s)
    return [
        *(Shot(float(time_s), step_s, first, slowed=False, told=False) for time_s in before),
        *(
            Shot(float(time_s), slowed_s, eased(first, near, k), slowed=True, told=False)
            for k, time_s in enumerate(slowed)
        ),
        Shot(usual_s, settings.hold_s, near, slowed=True, told=True),
        *(Shot(float(time_s), step_s, eased(near, last, k), slowed=False, told=True) for k, time_s in enumerate(after)),
    ]


def near_of(settings: PushFilm) -> Ends:
    """Return the ends of the time axis while time is slowed [s]."""
    return settings.slow_s[0] - settings.margin_s, settings.slow_s[1] + settings.margin_s


def eased(start: Ends, end: Ends, k: int) -> Ends:
    """Return the ends of the time axis [s] k frames after it began to change."""
    part = (1.0 - float(np.cos(np.pi * min(k / EASED, 1.0)))) / 2.0
    low, high = ((1.0 - part) * was + part * becomes for was, becomes in zip(start, end, strict=True))
    return low, high


def lines_of(felt: Mapping[str, PushResponse], errors_nm: Mapping[str, float]) -> list[tuple[str, ...]]:
    """Return the lines of the table at the end: heads of columns, then what each method shows, the last one first."""
    rows = [
        (method, f"{100.0 * response.share:.0f} %", _late(response.delay_ms), f"{errors_nm[method]:.0f} N m")
        for method, response in felt.items()
    ]
    return [HEADS, *rows[::-1]]


def _late(delay_ms: float | None) -> str:
    """Return a delay as text."""
    return "-" if delay_ms is None else f"{delay_ms:.0f} ms"


class _Stage:
    """What all frames share."""

    def __init__(
        self,
        settings: PushFilm,
        robot: RobotDescription,
        layout: JointLayout,
        hit: Collision,
        push: PushScene,
        course: TorquePlot,
        told: Sequence[tuple[str, ...]],
    ) -> None:
        self.settings = settings
        self.robot = robot
        self.layout = layout
        self.hit = hit
        self.push = push
        self.course = course
        self.told = told
        heading = np.median(np.unwrap([yaw_of(q) for q in push.q]))
        azimuth, elevation = settings.view_deg
        self.view = projection(float(np.rad2deg(heading)) + azimuth, elevation)
        self.centre = np.array([*np.median(push.q[:, :2], axis=0), 0.0])

    def frame(self, shot: Shot) -> Pixels:
        """Draw a frame."""
        moment = self.moment(shot.time_s, shot.ends_s, slowed=shot.slowed)
        return self._drawn(moment, shot.time_s, told=shot.told)

    def still(self) -> Pixels:
        """Draw the robot at the largest force, and all that is slowed of the torque."""
        peak_s = float(self.push.time_s[np.linalg.norm(self.push.force, axis=1).argmax()])
        moment = self.moment(peak_s, near_of(self.settings), slowed=True)
        return self._drawn(moment, self.settings.slow_s[1], told=True)

    def moment(self, time_s: float, ends_s: Ends, *, slowed: bool) -> Moment:
        """Return what a frame shows of the robot at a time [s]."""
        push = self.push
        times_s = push.time_s
        k = min(int(np.searchsorted(times_s, time_s)), len(times_s) - 1)
        side = next(side for side, leg in self.layout.legs.items() if leg == self.hit.leg)
        alarm = push.alarm
        part = ""
        said = ""
        if alarm and time_s >= alarm.delay_s:
            part = f"{side}_{alarm.link}_{alarm.direction}"
            said = f"detected: {side} {alarm.link}, {MS * alarm.delay_s:.0f} ms after contact"
        return Moment(
            standing(self.robot, push.q[k]),
            self.centre,
            f"{side}_{self.hit.link}_{self.hit.direction}",
            push.force[k],
            part,
            said,
            time_s,
            ends_s,
            f"slowed {self.settings.slower:g} times" if slowed else "real time",
        )

    def _drawn(self, moment: Moment, drawn_s: float, *, told: bool) -> Pixels:
        lines = self.told if told else self.settings.opening
        return draw_frame(self.robot, self.view, moment, self.course, drawn_s, lines)


def course_of(settings: PushFilm, push: PushScene, joint: str) -> TorquePlot:
    """Return the curves of a joint while they are shown [N m]."""
    k = push.joints.index(joint)
    stds = {method: std[:, k] for method, std in push.stds.items()}
    shown = {**push.torques(joint), TRUTH: push.truth[:, k]}
    low, high = (end(list(map(end, shown.values()))) for end in (np.min, np.max))
    room = ROOM * (high - low)
    title = f"External torque of the {settings.joint} [N m]"
    drawn = [TorqueCurve(name, values, stds.get(name)) for name, values in shown.items()]
    ends = (float(low - room), float(high + room))
    return TorquePlot(push.time_s, drawn, push.flags["swing"], title, settings.labels, ends)


def yaw_of(q: Array) -> float:
    """Return the yaw of the base at a position (nq,) [rad]."""
    return float(np.arctan2(2 * (q[3] * q[6] + q[4] * q[5]), 1 - 2 * (q[5] ** 2 + q[6] ** 2)))
