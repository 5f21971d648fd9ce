"""The metrics of scores, each with its unit and its range, declared here and nowhere else.

Modules of `experiments.evaluation.measure.estimates` measure them. The configuration accepts these names before
anything is computed, a score gets its unit from here, and files of scores are compared with both.
"""

import re
from dataclasses import dataclass
from functools import cache

from mobnet.core.errors import ConfigError, not_accepted

JOINT_UNITS = ("N", "N m")  # of the torques of joints: V1..V3, and all others


@dataclass(frozen=True)
class Metric:
    """Metrics that are measured alike.

    Attributes:
        names: pattern of their names.
        unit: their unit; braces stand for that of the joint.
        low: smallest value that there can be [unit]; None: no bound.
        high: largest value that there can be [unit]; None: no bound.
        section: section of the evaluation on whose tests alone they are measured, and name of the module that measures
            them; empty: on every test, by `run_errors`.
    """

    names: str
    unit: str = "{}"
    low: float | None = 0.0
    high: float | None = None
    section: str = ""

    @property
    def units(self) -> tuple[str, ...]:
        """Every unit that a score of it may have."""
        return tuple(dict.fromkeys(map(self.unit.format, JOINT_UNITS)))


METRICS = (
    Metric(r"gain_[0-9]+(\.[0-9]+)?hz", "-", section="bode"),
    Metric(r"phase_[0-9]+(\.[0-9]+)?hz", "deg", low=-180.0, high=180.0, section="bode"),
    Metric("(known|free|flagged)_share", "-", high=1.0, section="changed"),
    Metric("flags", "-", section="changed"),
    Metric("watched", "h", section="changed"),
    Metric("held_(swing|stance)(_[1-9][0-9]*)?", "-", low=None, section="drift"),
    Metric("push_share", "-", low=None, section="peaks"),
    Metric("rise_delay(_observer)?", "ms", low=None, section="peaks"),
    Metric("rise_bound", "-", high=1.0, section="peaks"),
    Metric("rmse_(swing|touch_down|stance|stuck|moving)", section="phases"),
    Metric("rmse(_raw|_label)?"),
    Metric("r_rmse", "%"),
    Metric("roughness", "{}/s"),
    Metric("rmse_(pushed|push_[1-9][0-9]*)(_raw)?"),
    Metric("rmse_part_[1-9][0-9]*", section="sigma"),
    Metric("std(_(swing|touch_down|stance|stuck|moving|pushed|calm|part_[1-9][0-9]*))?", section="sigma"),
    Metric(
        "cover(_(swing|touch_down|stance|stuck|moving|pushed|calm|part_[1-9][0-9]*))?", "-", high=1.0, section="sigma"
    ),
    Metric("excursion", "ms", section="sigma"),
    Metric("acf_[1-9][0-9]*ms", "-", low=-1.0, high=1.0, section="sigma"),
)
METRIC = "|".join(f"({metric.names})" for metric in METRICS)  # pattern of every name
SECTIONS = tuple(dict.fromkeys(metric.section for metric in METRICS if metric.section))


@cache
def metric_of(name: str) -> Metric:
    """Return the metric of a name.

    Raises:
        ConfigError: no metric has this name.
    """
    for metric in METRICS:
        if re.fullmatch(metric.names, name):
            return metric
    raise ConfigError(not_accepted("metric", name, (metric.names for metric in METRICS)))


def unit_of_metric(name: str, unit: str) -> str:
    """Return the unit of a metric of a joint whose torque has a unit."""
    return metric_of(name).unit.format(unit)
