"""The statements of the original with their verdicts: they read tables, scores and trainings."""

from collections.abc import Callable, Mapping
from pathlib import Path

from experiments.plan.files import Files
from experiments.plan.items.networks import all_kinds
from experiments.plan.product import Context, PaperItem
from experiments.settings.claims import numbers_of


def claims() -> Callable[..., None]:
    """Every statement with its verdict, as a table and as figures."""
    from experiments.evaluation.report.claims import claims

    return claims


def tables_of_claims(context: Context) -> Mapping[str, Path]:
    """Return the tables that claims name."""
    tables: dict[str, Path] = {}
    for claim in context.settings.claims.values():
        for number in numbers_of(claim):
            names = [cell.table for cell in number.cells if cell.table]
            tables |= {name: context.folders.tables / f"{name}.csv" for name in names}
    return tables


def claimed_networks(files: Files) -> tuple[Path, ...]:
    """Return the trainings that claims may ask about: all kinds, and all sizes, of the left leg's networks."""
    folders = [*all_kinds(files)]
    for size in files.swept_sizes():
        folders += size.folders
    return tuple(dict.fromkeys(folders))


def claims_summary() -> Callable[..., None]:
    """How many statements have each verdict."""
    from experiments.evaluation.tables.further.claims_summary import claims_summary

    return claims_summary


def claims_tolerance() -> Callable[..., None]:
    """How many statements hold at each tolerance."""
    from experiments.evaluation.tables.further.claims_tolerance import claims_tolerance

    return claims_tolerance


def ten_first() -> Callable[..., None]:
    """The ten statements that most readers ask for."""
    from experiments.evaluation.tables.further.ten_first import ten_first

    return ten_first


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        claims,
        table=True,
        figure=True,
        further=("claims_own",),
        given=lambda context: {
            "claims": context.settings.claims,
            "statistics": context.statistics,
            "methods": context.settings.methods,
            "detection": context.settings.detection,
            "published": context.published.original_methods,
            "layout": context.layout,
            "scores": context.scores(context.settings.claims),
            "folders": claimed_networks(context.files),
            "tables": tables_of_claims(context),
        },
    ),
    PaperItem(
        claims_summary,
        table=True,
        given=lambda context: {"claims_csv": context.folders.tables / "claims.csv"},
    ),
    PaperItem(
        claims_tolerance,
        table=True,
        given=lambda context: {"claims_csv": context.folders.tables / "claims.csv"},
    ),
    PaperItem(
        ten_first,
        table=True,
        given=lambda context: {
            "claims": context.settings.claims,
            "claims_csv": context.folders.tables / "claims.csv",
            "statistics": context.statistics,
        },
    ),
)
