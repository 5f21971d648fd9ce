"""Figures of trials: they read a table that the repository keeps of them, in docs/trials."""

from collections.abc import Callable

from experiments.plan.product import PaperItem
from experiments.plan.project import project_file


def learning_curve() -> Callable[..., None]:
    """Errors by the length of learning."""
    from experiments.evaluation.figures.further.learning_curve import learning_curve

    return learning_curve


def why_share() -> Callable[..., None]:
    """Which part of a hit is shown, by inputs, robot and learning."""
    from experiments.evaluation.figures.further.why_share import why_share

    return why_share


def hit_path() -> Callable[..., None]:
    """Which input brings in a hit."""
    from experiments.evaluation.figures.further.hit_path import hit_path

    return hit_path


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        learning_curve,
        figure=True,
        kept=True,
        given=lambda context: {
            "settings": context.evaluation.learning_curve,
            "kept": project_file(context.evaluation.learning_curve.data),
        },
    ),
    PaperItem(
        why_share,
        figure=True,
        kept=True,
        given=lambda context: {
            "settings": context.evaluation.why_share,
            "statistics": context.statistics,
            "kept": project_file(context.evaluation.why_share.data),
        },
    ),
    PaperItem(
        hit_path,
        figure=True,
        kept=True,
        given=lambda context: {
            "settings": context.evaluation.hit_path,
            "kept": project_file(context.evaluation.hit_path.data),
        },
    ),
)
