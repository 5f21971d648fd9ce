"""What tables and figures show and how each is made: one field of `Evaluation` for each, its section and its row.

`Evaluation`, what the plan makes, the tables that claims, the paper's text and its main tables read, and the checks of
the configuration follow from these rows.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated

from experiments.settings import table_columns
from experiments.settings.detection_tables import (
    AlarmTable,
    ContactPoints,
    DetectionCurves,
    Figure13,
    Figure14,
    Figure15,
    FoundByRate,
    Links,
    ReadingTable,
    SmallestForce,
    ThresholdTable,
)
from experiments.settings.figures import (
    CommandsFigure,
    Figure05,
    Figure06,
    Figure08,
    Figure09,
    Figure10,
    Figure17,
    Figure18,
    Figure19,
    Figure20,
    FineTuning,
    HandFigure,
    HitPath,
    LearningCurve,
    WhyShare,
)
from experiments.settings.measures import (
    Bode,
    CalibrationTable,
    Changed,
    Coverage,
    Drift,
    Measure,
    Peaks,
    Phases,
    Sigma,
)
from experiments.settings.metrics import SECTIONS
from experiments.settings.pages import Drawings, Explore, PaperText, PushFilm, Story
from experiments.settings.products import MadeBy, rows_of
from experiments.settings.reaction_tables import Figure16, Figure21, Figure22, Films, Safety, Sensorless
from experiments.settings.runs import LimbRuns, PushWindow, Statistics
from experiments.settings.tables import (
    Compute,
    DataTable,
    ErrorBudget,
    ErrorTable,
    Hourly,
    Kinds,
    LabelError,
    Latency,
    MainTables,
    MethodsRow,
    NoiseTable,
    Steps,
    Table01,
    Uncertainty,
)
from mobnet.settings import base
from mobnet.settings.base import Section

# Needs that many rows have: parameter of a function -> function of `experiments.plan.needs`.
SCORES = {"scores": "scores"}
RUNS = {"runs": "first_runs", "scores": "scores"}
DETECTIONS = {"detections": "detections"}


class Evaluation(Section):
    """All tables and figures."""

    # A section without a row belongs to several products, to a page of the report or to the text of the paper. The row
    # of `tables`, and that of `figures`, is the one of each of its entries.
    statistics: Statistics
    windows: dict[base.PushedName, PushWindow]
    table_01: Annotated[
        Table01,
        MadeBy(
            "tables.paper.table_01:table_01",
            needs={"networks": "printed_networks", "target": "learned_target"},
            table=True,
        ),
    ]
    tables: Annotated[
        dict[base.LowerName, ErrorTable], MadeBy("tables.paper.error_table:error_table", needs=SCORES, table=True)
    ]
    error_budget: Annotated[
        ErrorBudget,
        MadeBy(
            "tables.further.error_budget:error_budget", needs=SCORES, table=True, quoted=5, columns=table_columns.ERRORS
        ),
    ]
    noise: Annotated[
        NoiseTable,
        MadeBy(
            "tables.further.noise:noise", needs={"printed": "printed_tables", "scores": "scores"}, table=True, quoted=4
        ),
    ]
    figure_05: Annotated[
        Figure05,
        MadeBy(
            "figures.paper.figure_05:figure_05",
            needs={"scores": "scores", "runs": "first_runs_of_panels"},
            figure=True,
            bars=True,
        ),
    ]
    figure_06: Annotated[
        Figure06, MadeBy("figures.paper.figure_06:figure_06", needs=RUNS, figure=True, bars=True, pictured=True)
    ]
    figure_07: Annotated[
        HandFigure, MadeBy("figures.paper.hand_figure:hand_figure", needs=RUNS, figure=True, bars=True)
    ]
    figure_08: Annotated[Figure08, MadeBy("figures.paper.figure_08:figure_08", needs=RUNS, figure=True, bars=True)]
    figure_09: Annotated[Figure09, MadeBy("figures.paper.figure_09:figure_09", needs=RUNS, figure=True, bars=True)]
    figure_10: Annotated[
        Figure10,
        MadeBy(
            "figures.paper.figure_10:figure_10",
            needs={"scores": "scores", "runs": "first_runs_by_title"},
            figure=True,
            further=("figure_10_support",),
            bars=True,
            pictured=True,
        ),
    ]
    figure_12: Annotated[
        HandFigure, MadeBy("figures.paper.hand_figure:hand_figure", needs=RUNS, figure=True, bars=True)
    ]
    figure_17: Annotated[
        Figure17,
        MadeBy("figures.paper.figure_17:figure_17", needs={"folders": "networks_of_both_recipes"}, figure=True),
    ]
    kinds: Annotated[
        Kinds,
        MadeBy(
            "tables.further.kinds:kinds",
            needs={"folders": "networks_of_all_kinds"},
            sections=("figure_17",),
            table=True,
            quoted=9,
            columns=table_columns.KINDS,
        ),
    ]
    figure_18: Annotated[Figure18, MadeBy("figures.paper.figure_18:figure_18", needs=SCORES, figure=True)]
    methods: Annotated[
        base.Some[MethodsRow],
        MadeBy(
            "tables.further.methods:methods",
            needs=SCORES,
            table=True,
            quoted=1,
            source=True,
            columns=table_columns.METHODS,
        ),
    ]
    figure_19: Annotated[
        Figure19,
        MadeBy(
            "figures.paper.figure_19:figure_19",
            needs={"training": "sets_with_and_without_rte", "tests": "first_robot_tests"},
            sections=("coverage",),
            figure=True,
        ),
    ]
    figure_20: Annotated[
        Figure20, MadeBy("figures.paper.figure_20:figure_20", needs={"sizes_of_networks": "swept_sizes"}, figure=True)
    ]
    learning_curve: Annotated[
        LearningCurve, MadeBy("figures.further.learning_curve:learning_curve", needs={"kept": "kept_file"}, figure=True)
    ]
    why_share: Annotated[
        WhyShare, MadeBy("figures.further.why_share:why_share", needs={"kept": "kept_file"}, figure=True)
    ]
    hit_path: Annotated[HitPath, MadeBy("figures.further.hit_path:hit_path", needs={"kept": "kept_file"}, figure=True)]
    fine_tuning: Annotated[
        FineTuning,
        MadeBy(
            "figures.further.fine_tuning:fine_tuning",
            needs={"seconds": "swept_values", "scores": "scores"},
            figure=True,
        ),
    ]
    coverage: Annotated[
        Coverage,
        MadeBy(
            "tables.further.coverage:coverage",
            needs={"training": "sets_with_and_without_rte", "tests": "first_robot_tests", "ports": "ports"},
            table=True,
            columns=table_columns.COVERAGE,
        ),
    ]
    calibration: Annotated[
        CalibrationTable,
        MadeBy(
            "report.calibration:calibration",
            needs={"folders": "networks_by_level", "runs": "runs_by_test"},
            sections=("coverage",),
            table=True,
            figure=True,
            columns=table_columns.CALIBRATION,
        ),
    ]
    peaks: Annotated[Peaks, MadeBy("tables.further.peaks:peaks", needs=SCORES, table=True, quoted=2, source=True)]
    bode: Annotated[Bode, MadeBy("figures.further.bode:bode", needs=SCORES, figure=True, further=("bode_all",))]
    drift: Annotated[Drift, MadeBy("figures.further.drift:drift", needs=SCORES, figure=True)]
    phases: Annotated[Phases, MadeBy("tables.further.phases:phases", needs=SCORES, table=True, quoted=3)]
    sigma: Annotated[Sigma, MadeBy("report.sigma:sigma", needs=SCORES, table=True, figure=True)]
    changed: Annotated[Changed, MadeBy("tables.further.changed:changed", needs=SCORES, table=True, quoted=7)]
    hourly: Annotated[
        Hourly,
        MadeBy(
            "tables.further.hourly:hourly",
            needs={"walks": "walks_by_kind", "scores": "scores_of_known_robots"},
            sections=("changed",),
            table=True,
            quoted=8,
            columns=table_columns.HOURLY,
        ),
    ]
    measures: dict[base.LowerName, Measure] = {}
    figures: Annotated[
        dict[base.LowerName, LimbRuns],
        MadeBy(
            "figures.further.{name}:{name}",
            needs={"scores": "scores", "runs": "first_runs", "sets": "training_sets"},
            figure=True,
        ),
    ] = {}
    table_09: Annotated[
        ReadingTable,
        MadeBy(
            "tables.paper.table_09:table_09",
            needs=DETECTIONS,
            sections=("smallest_force",),
            table=True,
            quoted=10,
            source=True,
            columns=table_columns.DETECTION,
            clustered=True,
        ),
    ]
    table_13: Annotated[
        ThresholdTable,
        MadeBy(
            "tables.paper.table_13:table_13", needs=DETECTIONS, table=True, source=True, columns=table_columns.DETECTION
        ),
    ]
    false_alarms: Annotated[
        AlarmTable,
        MadeBy(
            "tables.further.false_alarms:false_alarms",
            needs=DETECTIONS,
            table=True,
            quoted=11,
            source=True,
            columns=table_columns.DETECTION,
        ),
    ]
    safety: Annotated[
        Safety,
        MadeBy(
            "tables.further.safety:safety",
            needs={"reactions": "reactions"},
            published="section_5_4",
            table=True,
            quoted=16,
            columns=table_columns.SAFETY,
            clustered=True,
        ),
    ]
    sensorless: Annotated[
        Sensorless,
        MadeBy(
            "tables.further.sensorless:sensorless",
            needs={"reactions": "reactions"},
            table=True,
            quoted=17,
            columns=table_columns.SENSORLESS,
            clustered=True,
        ),
    ]
    figure_16: Annotated[
        Figure16,
        MadeBy(
            "figures.paper.figure_16:figure_16",
            needs={"reactions": "reactions", "courses": "courses"},
            published="section_5_4",
            figure=True,
        ),
    ]
    figure_21: Annotated[
        Figure21,
        MadeBy("figures.paper.figure_21:figure_21", needs={"courses": "courses_of_case"}, figure=True, pictured=True),
    ]
    figure_22: Annotated[
        Figure22,
        MadeBy(
            "figures.paper.figure_22:figure_22",
            needs={"reactions": "reactions", "courses": "first_courses"},
            figure=True,
        ),
    ]
    story: Story
    films: Films
    push_film: PushFilm
    drawings: Drawings
    found_by_rate: Annotated[
        FoundByRate,
        MadeBy(
            "tables.further.found_by_rate:found_by_rate",
            needs=DETECTIONS,
            table=True,
            quoted=12,
            source=True,
            columns=table_columns.DETECTION,
            clustered=True,
        ),
    ]
    smallest_force: Annotated[
        SmallestForce,
        MadeBy(
            "tables.further.smallest_force:smallest_force",
            needs=DETECTIONS,
            table=True,
            quoted=13,
            columns=table_columns.DETECTION,
        ),
    ]
    links: Annotated[
        Links,
        MadeBy("tables.further.links:links", needs=DETECTIONS, table=True, quoted=14, columns=table_columns.DETECTION),
    ]
    contact_points: Annotated[
        ContactPoints,
        MadeBy(
            "tables.further.contact_points:contact_points",
            needs={"detections": "detections", "runs": "all_runs", "pushes": "pushes_of_test"},
            table=True,
            quoted=15,
            columns=table_columns.DETECTION,
        ),
    ]
    figure_13: Annotated[
        Figure13,
        MadeBy(
            "figures.paper.figure_13:figure_13", needs={"detections": "detections", "recordings": "struck"}, figure=True
        ),
    ]
    figure_14: Annotated[
        Figure14,
        MadeBy("figures.paper.figure_14:figure_14", needs=DETECTIONS, published="section_5_3", figure=True),
    ]
    figure_15: Annotated[
        Figure15,
        MadeBy(
            "figures.paper.figure_15:figure_15",
            needs={"detections": "detections", "recordings": "struck", "estimates": "estimates_of_struck"},
            figure=True,
        ),
    ]
    detection_curves: Annotated[
        DetectionCurves, MadeBy("figures.further.detection_curves:detection_curves", needs=DETECTIONS, figure=True)
    ]
    data: Annotated[DataTable, MadeBy("tables.further.data:data", needs={"sets": "training_sets"}, table=True)]
    commands: Annotated[
        CommandsFigure, MadeBy("figures.further.commands:commands", needs={"sets": "named_sets"}, figure=True)
    ]
    steps: Annotated[Steps, MadeBy("tables.further.steps:steps", needs={"sets": "walking_set"}, table=True)]
    uncertainty: Annotated[
        Uncertainty,
        MadeBy(
            "tables.further.uncertainty:uncertainty",
            needs={"sets": "residuals_by_set", "robots": "residuals_by_robot"},
            table=True,
        ),
    ]
    label_error: Annotated[
        LabelError,
        MadeBy("tables.further.label_error:label_error", needs={"walks": "first_walks"}, table=True, quoted=6),
    ]
    latency: Annotated[
        Latency,
        MadeBy(
            "tables.further.latency:latency",
            needs={"networks": "first_networks"},
            table=True,
            columns=table_columns.LATENCY,
        ),
    ]
    compute: Compute
    explore: Explore
    main_tables: MainTables
    paper: PaperText


CLAIMED: Mapping[str, MadeBy] = {  # products made from the claims, which are no section of `Evaluation`
    "claims": MadeBy(
        "report.claims:claims",
        needs={"scores": "claimed_scores", "folders": "claimed_networks"},
        published="original_methods",
        table=True,
        figure=True,
        further=("claims_own",),
        pictured=True,
    ),
    "claims_summary": MadeBy("tables.further.claims_summary:claims_summary", table=True),
    "claims_tolerance": MadeBy("tables.further.claims_tolerance:claims_tolerance", table=True),
    "ten_first": MadeBy("tables.further.ten_first:ten_first", table=True),
}
ENTRIES = ("tables", "figures")  # fields whose entries are products, each by its own name
PRODUCTS: Mapping[str, MadeBy] = {**rows_of(Evaluation), **CLAIMED}


def row_of(evaluation: Evaluation, name: str) -> MadeBy:
    """Return the row of a product: its own, or that of the field in which it is an entry."""
    for field in ENTRIES:
        if name in getattr(evaluation, field):
            row = PRODUCTS[field]
            return replace(row, function=row.function.format(name=name))
    return PRODUCTS[name]


def measured_in(evaluation: Evaluation) -> dict[str, Section]:
    """Return the sections that ask for metrics of their own, in order: those of products, then `measures`."""
    names = [name for name in Evaluation.model_fields if name in SECTIONS]
    return {**{name: getattr(evaluation, name) for name in names}, **evaluation.measures}
