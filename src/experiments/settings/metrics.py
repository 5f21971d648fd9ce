"""The metrics of scores, each declared beside the code that measures it and nowhere else.

A module of `experiments.evaluation.measure.estimates` has the name of its section of the evaluation and declares
`METRICS`; those of `run_errors` are measured on every test. Here they are read, not imported: the configuration accepts
these names before anything is computed, a score gets its unit from here, and files of scores are compared with both.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from mobnet.core.errors import ConfigError, not_accepted

MEASURES = Path(__file__).parents[1] / "evaluation" / "measure" / "estimates"
ALWAYS = "run_errors"  # the module whose metrics are measured on every test
JOINT_UNITS = ("N", "N m")  # of the torques of joints: V1..V3, and all others


@dataclass(frozen=True)
class Metric:
    """Metrics that are measured alike; their declaration holds literals alone.

    Attributes:
        names: pattern of their names.
        unit: their unit; braces stand for that of the joint.
        low: smallest value that there can be [unit]; None: no bound.
        high: largest value that there can be [unit]; None: no bound.
        section: section of the evaluation on whose tests alone they are measured, which is the name of their module;
            empty: on every test.
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


def declared() -> Iterator[Metric]:
    """Yield the metrics of all modules of measures."""
    for path in sorted(MEASURES.glob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "METRICS":
                section = "" if path.stem == ALWAYS else path.stem
                yield from (replace(metric, section=section) for metric in _metrics(node.value))


def _metrics(value: ast.expr) -> Iterator[Metric]:
    """Yield the metrics of a tuple of declarations."""
    calls = value.elts if isinstance(value, ast.Tuple) else ()
    for call in (call for call in calls if isinstance(call, ast.Call)):
        named = {word.arg: ast.literal_eval(word.value) for word in call.keywords if word.arg}
        yield Metric(*map(ast.literal_eval, call.args), **named)


METRICS = tuple(declared())
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
