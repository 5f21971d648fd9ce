"""What the tables, figures and films of reactions show: one section for each."""

from typing import Annotated

from pydantic import Field

from mobnet.formats import base
from mobnet.formats.base import Section


class Safety(Section):
    """What reactions are worth; a direction is right within an angle, an impulse is heavy above a bound.

    In the cases `stood_on` the obstacle carries the robot: its impulse is none of a collision.
    """

    cases: base.Distinct[base.CaseName]
    stood_on: base.Distinct[base.CaseName] = ()
    within_deg: Annotated[base.Positive, Field(le=180)]
    heavy_ns: Annotated[base.Positive, Field(le=1000)]


class Sensorless(Section):
    """Walks that nothing stands in the way of, with what is estimated in place of force sensors."""

    cases: base.Distinct[base.CaseName]


class Figure16(Safety):
    """Force of an obstacle over time in one walk of each case, `shown_s` from its contact on, every so many samples."""

    shown_s: base.Span[base.Real]
    every: base.Count


class Figure21(Section):
    """Footsteps of the first walk of a case."""

    case: base.CaseName


class Figure22(Section):
    """Pictures of a walk of each case: moments from the contact on [s], and azimuth and elevation of each view [deg].

    The moment of the largest force and the end of the walk are shown besides.
    """

    cases: base.Distinct[base.CaseName]
    moments_s: base.Some[base.Real]
    views_deg: dict[base.CaseName, tuple[base.Real, base.Real]]


class Films(Section):
    """Films of the first walk of each case: the joint that is shown, the view, and the time that a film has.

    A view is an azimuth and an elevation [deg].
    """

    joints: dict[base.CaseName, base.JointName]
    views_deg: dict[base.CaseName, tuple[base.Real, base.Real]]
    shown_s: base.Span[base.Real]
    history_s: Annotated[base.Real, Field(ge=0.1, le=60)]
    frames_hz: Annotated[base.Real, Field(ge=1, le=60)]
    slower: Annotated[base.Real, Field(ge=0.1, le=100)]
