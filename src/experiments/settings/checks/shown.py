"""What must hold for tables and figures: what they show is run, estimated, trained and pushed."""

from collections.abc import Iterator, Sequence

from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.claims import claim_problems
from experiments.settings.checks.detection import detection_problems
from experiments.settings.checks.estimates import asked_problems
from experiments.settings.checks.measures import measured_problems
from experiments.settings.checks.pages import page_problems
from experiments.settings.checks.reaction import reaction_problems
from experiments.settings.checks.results import Results
from experiments.settings.checks.story import story_problems
from experiments.settings.runs import Mean
from experiments.settings.settings import Settings
from experiments.settings.tables import ErrorTable
from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.reading import Place, Problem

ROOT: Place = ("evaluation",)
LEAST_DRAWN = 10  # samples of a figure


def shown_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what does not fit in tables, figures, claims and printed numbers."""
    settings = catalogue.settings
    results = Results(catalogue)
    for name, table in settings.evaluation.tables.items():
        for place, text in _table_problems(results, table):
            yield (*ROOT, "tables", name, *place), text
    yield from _budget_problems(results)
    yield from _figure_problems(results)
    yield from _leg_problems(results)
    yield from _trained_problems(results)
    yield from _sweep_problems(results)
    yield from _test_problems(results)
    yield from _method_table_problems(results)
    yield from measured_problems(results)
    yield from detection_problems(results)
    yield from reaction_problems(results)
    yield from story_problems(results)
    yield from page_problems(results)
    yield from asked_problems(catalogue)
    yield from claim_problems(results)
    yield from _printed_problems(settings)


def _column_problems(results: Results, columns: Sequence[str | Mean]) -> Iterator[tuple[Place, str]]:
    """Yield columns with a name that another one has, and means over forces and torques together."""
    names = list[str]()
    for index, column in enumerate(columns):
        new = list(results.joints(column)) if isinstance(column, str) else [column.name]
        for name in set(new) & set(names):
            yield (index,), misfit(name, "columns with names of their own")
        names += new
        if isinstance(column, Mean):
            held = results.joints_of(column)
            if len(set(held)) < len(held):
                yield (index, "joints"), misfit(list(column.joints), "each joint once")
            units = {results.layout.unit(joint) for joint in held}
            if len(units) > 1:
                yield (index, "joints"), misfit(list(column.joints), "joints with one unit, N or N m")


def _table_problems(results: Results, table: ErrorTable) -> Iterator[Problem]:
    """Yield columns, rows and names of a table of errors that do not fit it."""
    for place, text in _column_problems(results, table.columns):
        yield ("columns", *place), text
    columns = results.column_names(table.columns)
    order = [columns.index(name) for name in table.parts if name in columns]
    if len(order) < len(table.parts) or order != sorted(order) or 0 in order:
        yield ("parts",), misfit(list(table.parts), f"columns in their order: {', '.join(columns[1:])}")
    shown = set[str]()
    for row in table.rows:
        shown |= {*row.methods, *row.further}
    for name in table.names.keys() - shown:
        yield ("names", name), not_accepted("method", name, shown)
    own = set[str]()
    for column in table.columns:
        own.update(column.metrics if isinstance(column, Mean) else ())
    for index, row in enumerate(table.rows):
        place = ("rows", index)
        if len(row.labels) != len(table.header):
            text = misfit(f"{len(row.labels)} labels", f"{len(table.header)}, one for each text of header")
            yield (*place, "labels"), text
        for metric in sorted(own | {row.metric}):
            if text := results.not_scored(row.scenario, metric):
                yield (*place, "metric" if metric == row.metric else "scenario"), text
        for k, method in enumerate(row.further):
            if method in row.methods:
                yield (*place, "further", k), misfit(method, "methods that are not among `methods`")


def _budget_problems(results: Results) -> Iterator[Problem]:
    """Yield rows of the error budget that cannot be compared with the first one."""
    budget = results.settings.evaluation.error_budget
    place = (*ROOT, "error_budget")
    for inner, text in _column_problems(results, budget.joints):
        yield (*place, "joints", *inner), text
    first = budget.tests[0]
    for index, row in enumerate(budget.tests):
        before = budget.tests[:index]
        if any(row.level == other.level or row.label == other.label for other in before):
            yield (*place, "tests", index), misfit(row.level, "a level and a label in one row only")
        if (row.scenario, row.methods) != (first.scenario, first.methods):
            yield (*place, "tests", index, "scenario"), misfit(row.scenario, "that of the first row")


def _figure_problems(results: Results) -> Iterator[Problem]:
    """Yield what single figures cannot show."""
    evaluation = results.settings.evaluation
    figure = evaluation.figure_07
    against = evaluation.figure_10.against.methods
    drawn = (figure.end_s - figure.start_s) * results.settings.rates.data_hz / figure.every
    if drawn < LEAST_DRAWN:
        text = misfit(figure.end_s, f"{LEAST_DRAWN} drawn samples or more after {figure.start_s}")
        yield (*ROOT, "figure_07", "end_s"), text
    for title, test in evaluation.figure_10.tests.items():
        for k, method in enumerate(test.methods):
            if method not in against:
                place = (*ROOT, "figure_10", "tests", title, "methods", k)
                yield place, not_accepted("method", method, against)


def _leg_problems(results: Results) -> Iterator[Problem]:
    """Yield a limb of the coverage that is no leg, and joints that no push of the test turns."""
    settings = results.settings
    evaluation = results.settings.evaluation
    limb = evaluation.coverage.limb
    if limb not in results.legs or limb not in settings.robot.networks[limb].T:
        text = misfit(limb, f"a leg whose network sees its torques, `T`: {' or '.join(results.legs)}")
        yield (*ROOT, "coverage", "limb"), text
    step = evaluation.figure_06
    knee = evaluation.figure_10
    asked: list[tuple[Place, str, str]] = [((*ROOT, "figure_06", "joint"), step.scenario, step.joint)]
    for title, test in knee.tests.items():
        asked.append(((*ROOT, "figure_10", "tests", title, "scenario"), test.scenario, knee.joint))
    for name in ("coverage", "calibration"):
        for k, test in enumerate(getattr(evaluation, name).tests):
            if test.pushed is not None:
                asked.append(((*ROOT, name, "tests", k, "pushed"), test.scenario, test.pushed))
    for place, scenario, joint in asked:
        pushed = results.pushed_joints(scenario)
        if joint not in pushed:
            yield place, not_accepted(f"joint pushed in {scenario}", joint, pushed)


def _trained_problems(results: Results) -> Iterator[Problem]:
    """Yield methods and limbs that are not trained where networks are shown."""
    evaluation = results.settings.evaluation
    trained = results.trained(evaluation.figure_17.limb)
    for name, key in (("figure_17", "methods"), ("figure_17", "best"), ("kinds", "variants")):
        for k, method in enumerate(getattr(getattr(evaluation, name), key)):
            if method not in trained:
                text = not_accepted(f"method that trains {evaluation.figure_17.limb}", method, trained)
                yield (*ROOT, name, key, k), text
    for k, method in enumerate(evaluation.kinds.variants):
        if method in (*evaluation.figure_17.methods, *evaluation.figure_17.best):
            yield (*ROOT, "kinds", "variants", k), misfit(method, "methods that Figure 17 does not show")
    yield from _kind_problems(results)


def _kind_problems(results: Results) -> Iterator[Problem]:
    """Yield pairs of methods in Figure 17 that are not of one kind: those of a pair differ in how they learn alone."""
    figure = results.settings.evaluation.figure_17
    catalogue = results.catalogue
    place: Place = (*ROOT, "figure_17", "best")
    if len(figure.best) != len(figure.methods):
        yield place, misfit(f"{len(figure.best)} methods", f"{len(figure.methods)}, one for each of `methods`")
        return
    trained = results.trained(figure.limb)
    for k, (method, best) in enumerate(zip(figure.methods, figure.best, strict=True)):
        if best in figure.methods:
            yield (*place, k), misfit(best, "a method apart from `methods`")
        elif {method, best} <= {*trained}:
            networks = [catalogue.network(name, figure.limb) for name in (method, best)]
            if networks[0] != networks[1]:
                yield (*place, k), misfit(best, f"a method with the network of {method}")


def _sweep_problems(results: Results) -> Iterator[Problem]:
    """Yield sweeps that Figure 20 cannot show, and networks that Table 1 lacks."""
    settings = results.settings
    evaluation = results.settings.evaluation
    figure = evaluation.figure_20
    for key, section in (("parameters", "network"), ("samples", "learning")):
        sweep = settings.sweeps[getattr(figure, key)]
        if sweep.section != section or sweep.limb != figure.limb:
            accepted = f"a sweep of section {section} for {figure.limb}"
            yield (*ROOT, "figure_20", key), misfit(getattr(figure, key), accepted)
            return
    sizes = settings.sweeps[figure.parameters]
    own = settings.networks[figure.limb]
    if getattr(own, figure.parameters, None) not in sizes.values:
        text = misfit(list(sizes.values), f"values with {getattr(own, figure.parameters, None)}, that of Table 1")
        yield ("sweeps", figure.parameters, "values"), text
    for k, base in enumerate(settings.sweeps[figure.samples].of):
        if base not in sizes.of:
            text = not_accepted(f"method of sweep {figure.parameters}", base, sizes.of)
            yield ("sweeps", figure.samples, "of", k), text
    table = evaluation.table_01.method
    for limb in settings.published.table_01.rows:
        if table not in settings.methods or limb not in settings.methods[table].limbs:
            yield (*ROOT, "table_01", "method"), misfit(table, f"a method that trains {limb}, a row of Table 1")
            return


def _test_problems(results: Results) -> Iterator[Problem]:
    """Yield bounds for what the paper does not print, and tests without a dot."""
    settings = results.settings
    evaluation = results.settings.evaluation
    for limb in evaluation.uncertainty.ratio:
        if limb not in settings.published.uncertainty.std:
            text = not_accepted("limb", limb, settings.published.uncertainty.std)
            yield (*ROOT, "uncertainty", "ratio", limb), text
    if evaluation.figure_19.test_dots < len(evaluation.coverage.tests):
        yield (*ROOT, "figure_19", "test_dots"), misfit(evaluation.figure_19.test_dots, "a dot for each test")


def _method_table_problems(results: Results) -> Iterator[Problem]:
    """Yield columns of the table of methods that its limbs do not have."""
    for index, row in enumerate(results.settings.evaluation.methods):
        for limb, columns in row.columns.items():
            accepted = [*results.joints(limb), "avg"]
            for k, column in enumerate(columns):
                if column not in accepted:
                    place = (*ROOT, "methods", index, "columns", limb, k)
                    yield place, not_accepted(f"column of {limb}", column, accepted)


def _printed_problems(settings: Settings) -> Iterator[Problem]:
    """Yield places of numbers of the paper that are shown and that it does not print."""
    evaluation = settings.evaluation
    printed = settings.published.tables
    shown = list[tuple[Place, str, str | None]]()
    for name, table in evaluation.tables.items():
        shown += [(("tables", name, "rows", k, "paper"), name, row.paper) for k, row in enumerate(table.rows)]
    shown += [(("noise", "paper", name), name, place) for name, place in evaluation.noise.paper.items()]
    shown += [
        ((f"figure_{k}", "place"), figure.table, figure.place)
        for k, figure in {"07": evaluation.figure_07, "08": evaluation.figure_08, "09": evaluation.figure_09,
                          "12": evaluation.figure_12}.items()
    ]  # fmt: skip
    shown += [
        (("figure_05", "panels", level), evaluation.figure_05.table, level) for level in evaluation.figure_05.panels
    ]
    for place, name, paper in shown:
        accepted = printed[name].numbers if name in printed else {}
        if paper is not None and paper not in accepted:
            yield (*ROOT, *place), not_accepted("place of a row", paper, accepted)
