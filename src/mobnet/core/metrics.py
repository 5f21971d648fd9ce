"""The metrics of scores: each has its names, its unit, its range and who asks for it here, and nowhere else.

The modules of `mobnet.evaluation.measure` say what each one is. The configuration accepts these names, a score gets
its unit from here, and a file of scores from outside is compared with both.
"""

import re
from dataclasses import dataclass

from mobnet.core.errors import ConfigError, not_accepted

PART = "swing|touch_down|stance|stuck|moving"  # parts of a walk
NUMBER = "[1-9][0-9]*"
JOINT_UNITS = ("N", "N m")  # of the torques of joints: V1..V3, and all others
SHARE, CORRELATION = (0.0, 1.0), (-1.0, 1.0)


@dataclass(frozen=True)
class MetricKind:
    """Metrics that are measured alike.

    Attributes:
        names: pattern of their names.
        unit: their unit; braces stand for that of the joint.
        section: section of the evaluation on whose tests alone they are measured; empty: on every test.
        ends: smallest and largest value that there can be, where both are known [unit].
    """

    names: str
    unit: str = "{}"
    section: str = ""
    ends: tuple[float, float] | None = None


METRIC_KINDS = (
    MetricKind("rmse(_raw|_label)?"),
    MetricKind("r_rmse", "%"),
    MetricKind("roughness", "{}/s"),
    MetricKind(f"rmse_(pushed|push_{NUMBER})(_raw)?"),
    MetricKind("peak_ratio(_observer)?", "-", "peaks"),
    MetricKind("rise_delay(_observer)?", "ms", "peaks"),
    MetricKind(r"gain_[0-9]+(\.[0-9]+)?hz", "-", "bode"),
    MetricKind(r"phase_[0-9]+(\.[0-9]+)?hz", "deg", "bode"),
    MetricKind(f"held_(swing|stance)(_{NUMBER})?", "-", "drift"),
    MetricKind(f"rmse_({PART})", section="phases"),
    MetricKind(f"rmse_part_{NUMBER}", section="sigma"),
    MetricKind(f"std(_({PART}|pushed|calm|part_{NUMBER}))?", section="sigma"),
    MetricKind(f"cover(_({PART}|pushed|calm|part_{NUMBER}))?", "-", "sigma", SHARE),
    MetricKind("excursion", "ms", "sigma"),
    MetricKind(f"acf_{NUMBER}ms", "-", "sigma", CORRELATION),
    MetricKind("(known|free|flagged)_share", "-", "changed", SHARE),
)
METRIC = "|".join(f"({kind.names})" for kind in METRIC_KINDS)  # pattern of every name
SECTIONS = tuple(dict.fromkeys(kind.section for kind in METRIC_KINDS if kind.section))
UNITS = tuple(dict.fromkeys(kind.unit.format(unit) for kind in METRIC_KINDS for unit in JOINT_UNITS))  # of a score


def kind_of_metric(name: str) -> MetricKind:
    """Return the kind of a metric.

    Raises:
        ConfigError: no metric has this name.
    """
    for kind in METRIC_KINDS:
        if re.fullmatch(kind.names, name):
            return kind
    raise ConfigError(not_accepted("metric", name, (kind.names for kind in METRIC_KINDS)))


def unit_of_metric(name: str, unit: str) -> str:
    """Return the unit of a metric of a joint whose torque has a unit."""
    return kind_of_metric(name).unit.format(unit)
