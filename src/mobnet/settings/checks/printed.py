"""What must hold for the paper's printed numbers: tables and figures find them, and they fit each other."""

import re
from collections.abc import Iterator, Mapping, Sequence

from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.checks.results import Results
from mobnet.settings.published import ARCHITECTURE, PublishedTable
from mobnet.settings.reading import Place
from mobnet.settings.settings import Settings

AVERAGE_TOLERANCE = 0.01  # averages are printed with two digits
MINUTE_S = 60.0
DETECTED, TRIED = "detected", 10  # place of Table 9, and how often each kind of collision was tried (section 5.3)
TOGETHER = ("avg", "all")  # columns about those before
SIMILAR = 1.1  # ratio of the sizes of networks "of about the same size"
JOINT = re.compile(r"[A-Z]+(\d|$)")
VARIANTS = re.compile(r"(.+?)(-OR|-mean|-sigma)?")  # detectors of sections 5.3 and 6, named after their method
Problem = tuple[Place, str]
Wanted = Mapping[str, set[str]]  # place in a table -> methods that are shown there


def printed_problems(results: Results) -> Iterator[Problem]:
    """Yield printed numbers that nobody would find, or that contradict each other."""
    settings = results.settings
    for name, table in settings.published.tables.items():
        for place, text in (*_place_problems(results, name, table), *_row_problems(results, table)):
            yield ("published", "tables", name, *place), text
    for name, shown in settings.evaluation.tables.items():
        printed = settings.published.tables.get(name)
        for k, row in enumerate(shown.rows):
            accepted = printed.numbers if printed else {}
            if row.paper is not None and row.paper not in accepted:
                yield ("evaluation", "tables", name, "rows", k, "paper"), not_accepted("paper", row.paper, accepted)
    for name, place in settings.evaluation.noise.paper.items():
        printed = settings.published.tables.get(name)
        if printed is None or place not in printed.numbers:
            accepted = printed.numbers if printed else settings.published.tables
            text = not_accepted("place of a row" if printed else "table", place if printed else name, accepted)
            yield ("evaluation", "noise", "paper", name), text
    for name in ("figure_06", "figure_10"):
        if name not in settings.published.tables:
            yield ("published", "tables"), misfit(f"no {name}", f"{name}, whose numbers a figure shows")
    yield from _network_problems(settings)
    for limb, values in settings.published.uncertainty.std.items():
        if len(values) != len(settings.layout.limb(limb)):
            accepted = f"{len(settings.layout.limb(limb))}, one for each joint"
            yield ("published", "uncertainty", "std", limb), misfit(f"{len(values)} numbers", accepted)
    yield from _said_problems(settings)
    order, parameters = settings.published.kinds.order, settings.published.kinds.parameters
    sizes = [size for method, size in parameters.items() if method in order]
    if sizes and max(sizes) > SIMILAR * min(sizes):
        text = misfit(sizes, "sizes of the kinds in `order` that differ by a tenth at most")
        yield ("published", "kinds", "parameters"), text
    if sorted(order.values()) != list(range(1, len(order) + 1)):
        yield ("published", "kinds", "order"), misfit(list(order.values()), f"1 to {len(order)}, each once")
    for key in ("order", "parameters"):
        for method in getattr(settings.published.kinds, key):
            if method not in settings.evaluation.figure_17.methods:
                text = not_accepted("method of Figure 17", method, settings.evaluation.figure_17.methods)
                yield ("published", "kinds", key, method), text


def _shown(results: Results, name: str) -> tuple[Wanted, Sequence[str]] | None:
    """Return what a table or a figure shows of the paper's numbers, and the columns; None if it shows nothing."""
    evaluation = results.settings.evaluation
    if name in evaluation.tables:
        wanted = dict[str, set[str]]()
        for row in evaluation.tables[name].rows:
            wanted.setdefault(row.paper or "", set()).update(row.methods)
        return wanted, results.column_names(evaluation.tables[name].columns)
    if name == "figure_06":
        return {evaluation.figure_06.level: set(evaluation.figure_06.methods)}, [evaluation.figure_06.joint]
    if name == "figure_10":
        return {row.scenario: set(row.methods) for row in evaluation.figure_10.tests.values()}, ["avg"]
    return None


def _place_problems(results: Results, name: str, table: PublishedTable) -> Iterator[Problem]:
    """Yield places, methods and columns of a table that is shown which the table does not show."""
    shown = _shown(results, name)
    if shown is None:
        joints = results.layout.names
        for k, column in enumerate(table.columns):
            if JOINT.match(column) and column not in joints:
                yield ("columns", k), not_accepted("joint", column, joints)
        return
    wanted, columns = shown
    if list(table.columns) != list(columns):
        yield ("columns",), misfit(list(table.columns), f"{', '.join(columns)}, as in section evaluation")
    for place, rows in table.numbers.items():
        if place not in wanted:
            yield ("numbers", place), not_accepted("place that is shown", place, wanted)
        for method in rows.keys() - wanted.get(place, rows.keys()):
            yield ("numbers", place, method), not_accepted("method that is shown", method, wanted[place])


def _row_problems(results: Results, table: PublishedTable) -> Iterator[Problem]:
    """Yield rows that are no method, are too short, or whose averages are not those of their numbers."""
    for place, rows in table.numbers.items():
        for method, row in rows.items():
            base = VARIANTS.fullmatch(method)
            if base is None or base[1] not in results.catalogue.all_methods:
                yield ("numbers", place, method), not_accepted("method", method, results.settings.methods)
            if place == DETECTED:
                yield from _detected_problems(("numbers", place, method), row)
            if len(row) != len(table.columns):
                text = misfit(f"{len(row)} numbers", f"{len(table.columns)}, one for each column")
                yield ("numbers", place, method), text
            else:
                yield from ((("numbers", place, method, k), text) for k, text in _wrong_averages(table.columns, row))
    floor = table.floor
    if floor is not None and floor.method not in table.numbers.get(floor.level, {}):
        accepted = [f"{method} at {place}" for place, rows in table.numbers.items() for method in rows]
        yield ("floor",), not_accepted("row", f"{floor.method} at {floor.level}", accepted)


def _wrong_averages(columns: Sequence[str], row: Sequence[float | None]) -> Iterator[tuple[int, str]]:
    """Yield averages that are not the mean of the numbers since the last one; `all` may be their sum."""
    since = list[float | None]()
    for k, (column, value) in enumerate(zip(columns, row, strict=True)):
        if not column.startswith(TOGETHER):
            since.append(value)
            continue
        known, is_average = [number for number in since if number is not None], column != TOGETHER[1]
        if value is not None and known:
            mean = sum(known) / len(known)
            wrong = abs(mean - value) > AVERAGE_TOLERANCE and (is_average or value != sum(known))
            if wrong or (is_average and len(known) < len(since)):
                yield k, misfit(value, f"{mean:.2f}, the mean of {known}, of which none is missing")
        since = []


def _detected_problems(place: Place, row: Sequence[float | None]) -> Iterator[Problem]:
    """Yield collisions that were detected more often than there were: the last number is the total."""
    for k, value in enumerate(row[:-1]):
        if value is not None and value > TRIED:
            yield (*place, k), misfit(value, f"at most {TRIED}, collisions of each kind")


def _said_problems(settings: Settings) -> Iterator[Problem]:
    """Yield numbers of samples that do not fit the duration."""
    for name, said in settings.published.data.sets.items():
        if not 0.0 <= said.get("time standing", 0.0) <= 1.0:
            place = ("published", "data", "sets", name, "time standing")
            yield place, misfit(said["time standing"], "0 to 1, a share")
        if "duration" in said and "samples" in said:
            count = said["duration"] * MINUTE_S * settings.rates.data_hz
            if said["samples"] != count:
                place = ("published", "data", "sets", name, "samples")
                yield place, misfit(said["samples"], f"{count:g}, the samples in {said['duration']:g} minutes")


def _network_problems(settings: Settings) -> Iterator[Problem]:
    """Yield rows of Table 1 whose number of parameters is not that of their architecture, a GRU and a linear layer."""
    for limb, row in settings.published.table_01.rows.items():
        found = re.match(ARCHITECTURE, row.architecture)
        inputs, state, width, outputs = map(int, found.groups()) if found else (0, 0, 0, 0)
        count = 3 * state * (inputs + state + 2) + width * outputs + outputs  # torch's GRU has two biases
        if state != width or count != row.parameters:
            place = ("published", "table_01", "rows", limb, "parameters")
            yield place, misfit(row.parameters, f"{count}, those of {row.architecture}")
    known = {row.parameters for row in settings.published.table_01.rows.values()}
    kinds = settings.published.kinds.parameters
    if "GRU" in kinds and kinds["GRU"] not in known:
        yield ("published", "kinds", "parameters", "GRU"), not_accepted("parameters of Table 1", kinds["GRU"], known)
