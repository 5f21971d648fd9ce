"""What pages, film and drawings of the report show, and the text of the paper: one section for each."""

from typing import Annotated

from pydantic import Field

from experiments.settings.runs import LimbRuns
from mobnet.formats import base
from mobnet.formats.base import Section


class Story(Section):
    """The push that demo, film and explorer show: the first of its name in the first recording of a robot's test.

    The time that is shown begins before it and ends after its beginning. An estimator that begins there is not judged
    for the first `settle_s`.
    """

    scenario: base.PushedName
    level: base.WatchedLevelName
    push: base.PushName
    before_s: Annotated[base.Positive, Field(le=10)]
    after_s: Annotated[base.Positive, Field(le=10)]
    settle_s: Annotated[base.NotNegative, Field(le=10)]
    joint: base.LegJointName
    methods: base.MethodNames
    detector: base.DetectorName


class PushFilm(Section):
    """The film of the push of `story`: the answer for `answer_s`, then real time, some of it slower, held for `hold_s`.

    The view is an azimuth from ahead and an elevation of the eye [deg]; times count from the beginning of the push;
    the time axis shows `margin_s` more than what is slowed; `colours` is the size of the palette. `kind` is the rule of
    the thresholds of the detector. Labels of methods, of `truth` and of `swing`, the name of the joint and the lines of
    the opening are texts of the film.
    """

    view_deg: tuple[base.Degrees, base.Degrees]
    frames_hz: base.Real = Field(ge=5, le=60)
    slowed_hz: base.Real = Field(ge=5, le=60)
    slower: base.Real = Field(ge=1, le=100)
    slow_s: base.Span[base.Real]
    answer_s: base.Seconds
    hold_s: base.Seconds
    margin_s: base.Pause
    colours: base.Whole = Field(ge=8, le=256)
    kind: base.ThresholdsName
    labels: dict[base.Text, base.Text]
    joint: base.Text
    opening: base.Some[base.Text]


class DrawingLabel(Section):
    """A text of the drawing of the robot: a point of a body that it names, and where it begins [m]."""

    text: base.Text
    body: base.BodyName
    pos: base.Vector3
    at_m: tuple[base.Real, base.Real]


class Drawings(Section):
    """The drawings of method and robot: limbs with networks, angles of joints that are not in the posture, the view.

    The view is an azimuth and an elevation [deg]; the corner is the lower left one of the picture, from the base on the
    ground. The axes of a leg's joints are drawn, and a push of `force_n` from ahead.
    """

    limbs: base.LimbNames
    pose_rad: dict[base.JointName, base.Radians]
    view_deg: tuple[base.Degrees, base.Degrees]
    corner_m: tuple[base.Real, base.Real]
    m_per_inch: base.Real = Field(ge=0.01, le=10)
    floor_m: base.Length
    leg: base.LegName
    force_n: base.Newton
    notes: tuple[DrawingLabel, ...] = ()


class ExploreStory(Section):
    """How the page calls the push and the plant of section `story`, and methods that it shows besides."""

    push: base.Text
    plant: base.Text
    threshold_nm: base.Real = Field(ge=0.1, le=1000)
    further: base.MethodNames


class ExploreScene(LimbRuns):
    """A scene of the page: the first push of the first run that begins from a time on, and the joint shown first.

    `push` and `plant` are the texts of its buttons, `gate` the method that tells of an early contact, where networks of
    that of detectors are not trained.
    """

    scenario: base.PushedName
    gate: base.MethodName | None = None
    push: base.Text
    plant: base.Text
    joint: base.MotorName
    threshold_nm: base.Real = Field(ge=0.1, le=1000)
    from_s: base.NotNegative = Field(default=0.0, le=3600)


class Explore(Section):
    """The page on which a reader plays with pushes.

    Samples are stored from `lead_s` before a scene on, torques in steps of `step_nm`, poses and forces at `pose_hz`. A
    slider runs between two ends; it begins at the observer's gain, or at the `threshold_nm` of the scene.
    """

    lead_s: base.Positive = Field(le=10)
    pose_hz: base.Real = Field(ge=10, le=1000)
    step_nm: base.Real = Field(ge=0.001, le=1)
    gains_hz: base.Span[Annotated[base.Real, Field(ge=1, le=1000)]]
    thresholds_nm: base.Span[Annotated[base.Real, Field(ge=0.1, le=1000)]]
    story: ExploreStory
    scenes: Annotated[dict[base.LowerName, ExploreScene], Field(min_length=1)]


class PaperText(Section):
    """The text of the paper: the scale for whose results its words were chosen, and the pages of its main text.

    No letter of a figure may be smaller than `type_pt` [points] in print.
    """

    scale: base.LowerName
    pages: Annotated[base.Count, Field(le=100)]
    type_pt: base.Real = Field(ge=4, le=12)
