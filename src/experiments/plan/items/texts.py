"""What makes the paper, the pages of the report, the films and the documentation, and what the paper takes of tables.

What each of them reads stands in `experiments.plan.products`, as it follows from all tables and figures.
"""

from collections.abc import Callable

from experiments.plan.items import claims, detectors, errors, networks, reactions, recordings, walks
from experiments.plan.product import Late

# Tables that the paper's text takes numbers from, those of errors apart, in the order of numbers.tex.
QUOTED: tuple[Late, ...] = (
    errors.methods,
    errors.peaks,
    errors.phases,
    errors.noise,
    errors.error_budget,
    recordings.label_error,
    errors.changed,
    recordings.hourly,
    networks.kinds,
    detectors.table_09,
    detectors.false_alarms,
    detectors.found_by_rate,
    detectors.smallest_force,
    detectors.links,
    detectors.contact_points,
    reactions.safety,
    reactions.sensorless,
)
# Tables that those of the paper's main text are made from, those of errors apart.
SOURCES: tuple[Late, ...] = (
    detectors.table_09,
    detectors.table_13,
    errors.methods,
    errors.peaks,
    detectors.false_alarms,
    detectors.found_by_rate,
)
# Figures that the first page of the report shows.
PICTURED: tuple[Late, ...] = (walks.figure_06, walks.figure_10, reactions.figure_21, claims.claims)


def pictures() -> Callable[..., None]:
    """Drawings of the method and of the robot, and the film of a push."""
    from experiments.evaluation.figures.further.pictures import pictures

    return pictures


def numbers() -> Callable[..., None]:
    """Numbers and captions that the paper takes, and the tables of its main text."""
    from experiments.evaluation.report.numbers import numbers

    return numbers


def deviations() -> Callable[..., None]:
    """What differs from the original, for the paper."""
    from experiments.evaluation.report.deviations import deviations

    return deviations


def runs_page() -> Callable[..., None]:
    """A page with the courses of all trainings."""
    from experiments.evaluation.report.runs_page import runs_page

    return runs_page


def wandb_runs() -> Callable[..., None]:
    """The trainings as offline runs of Weights & Biases."""
    from experiments.evaluation.report.wandb_runs import wandb_runs

    return wandb_runs


def demo_data() -> Callable[..., None]:
    """The push of `./reproduce demo`, with the networks and fits that it needs."""
    from experiments.evaluation.report.demo_data import demo_data

    return demo_data


def explore() -> Callable[..., None]:
    """A page on which a reader plays with pushes."""
    from experiments.evaluation.report.explore import explore

    return explore


def compute() -> Callable[..., None]:
    """What the jobs took, by their accounts."""
    from experiments.evaluation.report.compute import compute

    return compute


def paper() -> Callable[..., None]:
    """The paper."""
    from experiments.evaluation.report.paper import paper

    return paper


def pages() -> Callable[..., None]:
    """The pages of the report."""
    from experiments.evaluation.report.pages import pages

    return pages


def manifest() -> Callable[..., None]:
    """The hash of every file of results."""
    from experiments.evaluation.report.manifest import manifest

    return manifest


def films() -> Callable[..., None]:
    """Films of walks into obstacles."""
    from experiments.evaluation.figures.further.films import films

    return films


def docs() -> Callable[..., None]:
    """The documentation as pages."""
    from experiments.site.docs import docs

    return docs
