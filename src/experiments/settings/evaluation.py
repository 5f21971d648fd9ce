"""What tables and figures show: one field of `Evaluation` for each, its section, and the columns that claims may name.

The rows of `experiments.plan.items` say how each is made. They stand in the order of these fields.
"""

from collections.abc import Mapping
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
from experiments.settings.products import ClaimedTable, claimed_tables
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
from mobnet.formats import base
from mobnet.formats.base import Section


class Evaluation(Section):
    """All tables and figures."""

    # Each entry of `tables`, and of `figures`, is a table or a figure. Some sections belong to several of these, to a
    # page of the report or to the text of the paper.
    statistics: Statistics
    windows: dict[base.PushedName, PushWindow]
    table_01: Table01
    tables: dict[base.LowerName, ErrorTable]
    error_budget: Annotated[ErrorBudget, ClaimedTable(table_columns.ERRORS)]
    noise: NoiseTable
    figure_05: Figure05
    figure_06: Figure06
    figure_07: HandFigure
    figure_08: Figure08
    figure_09: Figure09
    figure_10: Figure10
    figure_12: HandFigure
    figure_17: Figure17
    kinds: Annotated[Kinds, ClaimedTable(table_columns.KINDS)]
    figure_18: Figure18
    methods: Annotated[base.Some[MethodsRow], ClaimedTable(table_columns.METHODS)]
    figure_19: Figure19
    figure_20: Figure20
    learning_curve: LearningCurve
    why_share: WhyShare
    hit_path: HitPath
    fine_tuning: FineTuning
    coverage: Annotated[Coverage, ClaimedTable(table_columns.COVERAGE)]
    calibration: Annotated[CalibrationTable, ClaimedTable(table_columns.CALIBRATION)]
    peaks: Peaks
    bode: Bode
    drift: Drift
    phases: Phases
    sigma: Sigma
    changed: Changed
    hourly: Annotated[Hourly, ClaimedTable(table_columns.HOURLY)]
    measures: dict[base.LowerName, Measure] = {}
    figures: dict[base.LowerName, LimbRuns] = {}
    table_09: Annotated[ReadingTable, ClaimedTable(table_columns.DETECTION, clustered=True)]
    table_13: Annotated[ThresholdTable, ClaimedTable(table_columns.DETECTION)]
    false_alarms: Annotated[AlarmTable, ClaimedTable(table_columns.DETECTION)]
    safety: Annotated[Safety, ClaimedTable(table_columns.SAFETY, clustered=True)]
    sensorless: Annotated[Sensorless, ClaimedTable(table_columns.SENSORLESS, clustered=True)]
    figure_16: Figure16
    figure_21: Figure21
    figure_22: Figure22
    story: Story
    films: Films
    push_film: PushFilm
    drawings: Drawings
    found_by_rate: Annotated[FoundByRate, ClaimedTable(table_columns.DETECTION, clustered=True)]
    smallest_force: Annotated[SmallestForce, ClaimedTable(table_columns.DETECTION)]
    links: Annotated[Links, ClaimedTable(table_columns.DETECTION)]
    contact_points: Annotated[ContactPoints, ClaimedTable(table_columns.DETECTION)]
    figure_13: Figure13
    figure_14: Figure14
    figure_15: Figure15
    detection_curves: DetectionCurves
    data: DataTable
    commands: CommandsFigure
    steps: Steps
    uncertainty: Uncertainty
    label_error: LabelError
    latency: Annotated[Latency, ClaimedTable(table_columns.LATENCY)]
    compute: Compute
    explore: Explore
    main_tables: MainTables
    paper: PaperText


CLAIMED_TABLES: Mapping[str, ClaimedTable] = claimed_tables(Evaluation)


def measured_in(evaluation: Evaluation) -> dict[str, Section]:
    """Return the sections that ask for metrics of their own, in order: those of products, then `measures`."""
    names = [name for name in Evaluation.model_fields if name in SECTIONS]
    return {**{name: getattr(evaluation, name) for name in names}, **evaluation.measures}
