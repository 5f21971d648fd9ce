"""What tables and figures show: one section for each, under its own name."""

from experiments.settings.detection_tables import (
    AlarmTable,
    ContactPoints,
    DetectionCurves,
    DetectorTable,
    Figure13,
    Figure14,
    Figure15,
    FoundByRate,
    Links,
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
    LearningCurve,
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


class Evaluation(Section):
    """All tables and figures."""

    statistics: Statistics
    windows: dict[base.PushedName, PushWindow]
    table_01: Table01
    tables: dict[base.LowerName, ErrorTable]
    error_budget: ErrorBudget
    noise: NoiseTable
    figure_05: Figure05
    figure_06: Figure06
    figure_07: HandFigure
    figure_08: Figure08
    figure_09: Figure09
    figure_10: Figure10
    figure_12: HandFigure
    figure_17: Figure17
    kinds: Kinds
    figure_18: Figure18
    methods: base.Some[MethodsRow]
    figure_19: Figure19
    figure_20: Figure20
    learning_curve: LearningCurve
    fine_tuning: FineTuning
    coverage: Coverage
    calibration: CalibrationTable
    peaks: Peaks
    bode: Bode
    drift: Drift
    phases: Phases
    sigma: Sigma
    changed: Changed
    hourly: Hourly
    measures: dict[base.LowerName, Measure] = {}
    figures: dict[base.LowerName, LimbRuns] = {}
    table_09: DetectorTable
    table_13: ThresholdTable
    false_alarms: AlarmTable
    safety: Safety
    sensorless: Sensorless
    figure_16: Figure16
    figure_21: Figure21
    figure_22: Figure22
    story: Story
    films: Films
    push_film: PushFilm
    drawings: Drawings
    found_by_rate: FoundByRate
    smallest_force: SmallestForce
    links: Links
    contact_points: ContactPoints
    figure_13: Figure13
    figure_14: Figure14
    figure_15: Figure15
    detection_curves: DetectionCurves
    data: DataTable
    commands: CommandsFigure
    steps: Steps
    uncertainty: Uncertainty
    label_error: LabelError
    latency: Latency
    compute: Compute
    explore: Explore
    main_tables: MainTables
    paper: PaperText


def measured_in(evaluation: Evaluation) -> dict[str, Section]:
    """Return the sections that ask for metrics of their own, in order: those of products, then `measures`."""
    names = [name for name in Evaluation.model_fields if name in SECTIONS]
    return {**{name: getattr(evaluation, name) for name in names}, **evaluation.measures}
