"""What makes the tables of trials; what each of them reads stands in `experiments.plan.trials`."""

from collections.abc import Callable


def trials() -> Callable[..., None]:
    """Variants of methods at their tasks."""
    from experiments.evaluation.tables.further.trials import trials

    return trials


def falls() -> Callable[..., None]:
    """Falls with random torques of several sizes."""
    from experiments.evaluation.tables.further.falls import falls

    return falls


def factorial() -> Callable[..., None]:
    """What the walks of training sets teach."""
    from experiments.evaluation.tables.further.factorial import factorial

    return factorial


def why() -> Callable[..., None]:
    """Why a hit is hidden."""
    from experiments.evaluation.tables.further.why import why

    return why
