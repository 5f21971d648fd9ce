"""Tables and figures of the errors of estimates: they read scores."""

from collections.abc import Callable

from experiments.plan.product import PaperItem


def error_table() -> Callable[..., None]:
    """A table of errors by test, method and joint, such as Table 7."""
    from experiments.evaluation.tables.paper.error_table import error_table

    return error_table


def error_table_of(name: str) -> PaperItem:
    """Return the row of an entry of `tables` in configs/evaluation.yaml, which says what it shows of which tests."""
    return PaperItem(
        error_table,
        entry=name,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.tables[name],
            "name": name,
            "statistics": context.statistics,
            "layout": context.layout,
            "published": context.published.tables.get(name),
            "scores": context.scores(context.evaluation.tables[name]),
        },
    )


def error_budget() -> Callable[..., None]:
    """What each cause adds to the error of the observer."""
    from experiments.evaluation.tables.further.error_budget import error_budget

    return error_budget


def noise() -> Callable[..., None]:
    """The paper's errors beside the noise that sensors have."""
    from experiments.evaluation.tables.further.noise import noise

    return noise


def figure_18() -> Callable[..., None]:
    """Errors of whole-body networks and of those of one limb."""
    from experiments.evaluation.figures.paper.figure_18 import figure_18

    return figure_18


def methods() -> Callable[..., None]:
    """All methods of the legs beside each other."""
    from experiments.evaluation.tables.further.methods import methods

    return methods


def fine_tuning() -> Callable[..., None]:
    """Errors on changed robots by how much new data a network saw."""
    from experiments.evaluation.figures.further.fine_tuning import fine_tuning

    return fine_tuning


def peaks() -> Callable[..., None]:
    """Which part of a push each method shows."""
    from experiments.evaluation.tables.further.peaks import peaks

    return peaks


def bode() -> Callable[..., None]:
    """The observer's response to pushes of several frequencies."""
    from experiments.evaluation.figures.further.bode import bode

    return bode


def drift() -> Callable[..., None]:
    """Which share of a long push each method shows, step by step."""
    from experiments.evaluation.figures.further.drift import drift

    return drift


def phases() -> Callable[..., None]:
    """Errors by phase of the gait."""
    from experiments.evaluation.tables.further.phases import phases

    return phases


def sigma() -> Callable[..., None]:
    """The standard deviations that networks predict, over a gait cycle and in a table."""
    from experiments.evaluation.report.sigma import sigma

    return sigma


def changed() -> Callable[..., None]:
    """Errors and warnings on robots that networks do not know."""
    from experiments.evaluation.tables.further.changed import changed

    return changed


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        error_budget,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.error_budget,
            "statistics": context.statistics,
            "layout": context.layout,
            "scores": context.scores(context.evaluation.error_budget),
        },
    ),
    PaperItem(
        noise,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.noise,
            "statistics": context.statistics,
            "layout": context.layout,
            "printed": {name: context.published.tables[name] for name in context.evaluation.noise.paper},
            "scores": context.scores(context.evaluation.noise),
        },
    ),
    PaperItem(
        figure_18,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_18,
            "windows": context.evaluation.windows,
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.figure_18),
        },
    ),
    PaperItem(
        methods,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.methods,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.methods),
        },
    ),
    PaperItem(
        fine_tuning,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.fine_tuning,
            "seconds": context.settings.sweeps[context.evaluation.fine_tuning.sweep].values,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.fine_tuning),
        },
    ),
    PaperItem(
        peaks,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.peaks,
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.peaks),
        },
    ),
    PaperItem(
        bode,
        figure=True,
        further=("bode_all",),
        given=lambda context: {
            "settings": context.evaluation.bode,
            "pushes": context.settings.pushes,
            "layout": context.layout,
            "observer": context.settings.observer,
            "rates": context.settings.rates,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.bode),
        },
    ),
    PaperItem(
        drift,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.drift,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.drift),
        },
    ),
    PaperItem(
        phases,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.phases,
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.phases),
        },
    ),
    PaperItem(
        sigma,
        table=True,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.sigma,
            "learning": context.settings.learning,
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.sigma),
        },
    ),
    PaperItem(
        changed,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.changed,
            "learning": context.settings.learning,
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.changed),
        },
    ),
)
