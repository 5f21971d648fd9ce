"""README and the page of findings: templates with the numbers of the published results, so that none is typed.

`python -m experiments.site readme` writes both; a test fails when one is out of date. Sentences that depend on results
have guards in the template: `holds("claim", "verdict", ...)` and `needs(truth, "what it says")`. They print nothing.
"""

import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from jinja2 import UndefinedError

from experiments.evaluation.measure.learning.explained import by_robot, read_why
from experiments.evaluation.measure.learning.taught import SHARE_OF_HIT
from experiments.evaluation.report.headline import AVERAGE, FILMED, best_formulas, headline
from experiments.evaluation.report.html import filled
from experiments.plan.prices import RATES, RatesNote
from experiments.settings.table_columns import CLAIMED
from experiments.settings.verdicts import NOT_REPRODUCED, PAPER, REPRODUCED, SIGN_ONLY
from experiments.site import machines
from experiments.site.blocks import with_block
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text
from mobnet.core.notes import read_note
from mobnet.core.rows import read_texts

RESULTS = Path("docs/results")
CLAIMS = "claims.csv"  # in a folder of results
README, GUIDE = Path("README.md"), Path("docs/guide.md")
TEMPLATE = Path("README.md.j2")
FOUND, FOUND_TEMPLATE = Path("docs/found.md"), Path("docs/found.md.j2")
# What each scale takes: scale, what it is, time on two cores, core-hours, memory, disk. The published run says what its
# own took, and prices what has not run yet.
SCALES = (
    ("smoke", "seconds of walking; its numbers mean nothing", "12 to 17 min", "0.6", "0.5 GiB", "1.1 GiB"),
    ("quick", "every item once, shorter walks", "50 min", "1.6", "4.2 GiB", "13 GiB"),
    ("default", "the published sizes", "", "", "5.6 GiB", "50 GiB"),
    ("paper", "3.6 million samples, 200 epochs", "", "", "21 GiB", "340 GiB"),
)
CORES = 2
HOURS_OF_A_DAY = 24
# Wall time [h] of the whole run in compute.md, and the share of the cores' time that it had [%].
ELAPSED = re.compile(r"^\| elapsed [^|]*\|[^|]*\|[^|]*\| (?P<hours>[\d.]+) \| (?P<load>\d+) \|", re.MULTILINE)
# What the data of networks teach, a trial that is kept: the effect of pushes over all levels of the others.
TAUGHT = Path("docs/trials/factorial.csv")
PUSHES = {
    "part": "effects", "name": "without / with pushes", "random_torque_nm": "", "pushes": "", "commands": "",
    "measure": "hits",
}  # fmt: skip
# What is seen of a hit without some inputs, a trial that is kept: its training set and way of learning.
EXPLAINED = Path("docs/trials/why.csv")
AS_THE_RUN = ("why_walk", "soap")
MOB_NET, NO_SENSOR = "MOB-Net", "MOB-Net-noimu"
HIT = {"scenario": "knee_swing", "level": "robots", "limb": "LL", "joint": "avg", "metric": "push_share"}
SHOWN = ("MOB-Net", FILMED)  # networks of which the README says how much of a hit they show
RATED = ("MOB-Net-pushed-ratio", "MOB-fric-load")
REACTION = "MOB-Net-pushed-ratio"  # detector after whose alarm the robot steps back
# What the page of findings tells beside the README: methods, and their rows.
MEMORY = "MOB-fric-dahl"  # the formula that is the best one on robots with unknown gears
UNDER_HITS = (MOB_NET, FILMED, MEMORY)
HIT_ERROR = {
    "scenario": "knee_swing", "level": "robots", "joint": "avg",
    "metric": "rmse_push_1+rmse_push_2+rmse_push_3+rmse_push_4",
}  # fmt: skip
LIMBS = {
    "leg": "walking (robots), leg", "arm": "hand pushed (robots), arm", "waist": "hand pushed (robots), waist",
    "base force": "hand pushed (robots), base force", "base torque": "hand pushed (robots), base torque",
}  # fmt: skip
COMPARED = ("MOB", MEMORY, MOB_NET)
# What is told of robots that networks know, and of others -> their level in one test.
CHANGED = {"known": "robots", "friction": "robots_friction", "other robot": "robots_other"}
CHANGED_WALK = {"scenario": "changed_walk", "limb": "LL", "method": MOB_NET, **AVERAGE}
Row = Mapping[str, str]


def tell_readme(results: Path = RESULTS) -> None:
    """Write README, page of findings, and into the guide what each scale takes, from published results."""
    write_text(README, readme(results))
    write_text(FOUND, found(results))
    write_text(GUIDE, with_block(read_text(GUIDE), "scales", scales(results), GUIDE))


def readme(results: Path, template: Path = TEMPLATE) -> str:
    """Return the README, from a folder of published results.

    Raises:
        DataError: a table or a row is missing, or is not as a sentence says.
    """
    claims = read_texts(results / CLAIMS)
    return _told(results, template, claims, values(results, claims, _rates(results)))


def found(results: Path, template: Path = FOUND_TEMPLATE) -> str:
    """Return the page of what was found, from a folder of published results.

    Raises:
        DataError: a table or a row is missing, or is not as a sentence says.
    """
    claims = read_texts(results / CLAIMS)
    return _told(results, template, claims, values(results, claims, _rates(results)) | found_values(results))


def check_told(tables: Path) -> None:
    """Check that README and page of findings tell what the tables of a run say, before these are published.

    Raises:
        DataError: a table or a row is missing, or is not as a sentence says.
    """
    claims = read_texts(tables / CLAIMS)
    told = values(tables, claims, _rates(RESULTS))  # no sentence depends on how long the run took
    _told(tables, TEMPLATE, claims, told)
    _told(tables, FOUND_TEMPLATE, claims, told | found_values(tables))


def _rates(results: Path) -> RatesNote:
    """Return what the jobs of the published run took."""
    return read_note(results / RATES.name, RatesNote)


def _told(results: Path, template: Path, claims: Sequence[Row], told: Mapping[str, object]) -> str:
    """Return a filled template; a DataError where it tells of what is not there, or a guard does not hold."""
    verdicts = {row["claim"]: row["verdict"] for row in claims}
    guards = {"holds": partial(_holds, template, verdicts), "needs": partial(_needs, template)}
    try:
        return filled(template, {**told, **guards})
    except UndefinedError as missing:
        raise DataError(f"{results}: {missing}, of which {template} tells") from missing


def values(results: Path, claims: Sequence[Row], rates: RatesNote) -> dict[str, object]:
    """Return what the template takes its numbers from, by name.

    Args:
        results: folder of tables.
        claims: rows of their table of claims.
        rates: what the jobs of the run took.

    Raises:
        DataError: a table or a row is missing, or is not as a sentence says.
    """
    falls = falls_of(results)
    summary = read_texts(results / "claims_summary.csv", CLAIMED)
    counts = {row["outcome"]: int(row["statements"]) for row in summary if row["score"] == PAPER}
    refuted = counts[NOT_REPRODUCED] + counts[SIGN_ONLY]
    detectors = read_texts(results / "detectors.csv")
    peaks = read_texts(results / "peaks.csv")
    return {
        "n": counts,
        "refuted": refuted,
        "undecided": counts["all"] - counts[REPRODUCED] - refuted,
        "idle_h": rates.core_h / CORES,
        "headline": headline(results),
        "best_formulas": best_formulas(results),
        "c": {row["claim"]: float(row["value"] or "nan") for row in claims},
        "share": {name: _value(peaks, {**HIT, "method": name}) for name in SHOWN},
        "trial": shown_in_trial(),
        "taught": _value(read_texts(TAUGHT), PUSHES),
        "found": {name: _value(detectors, {"row": name, "quantity": "found at rate"}) for name in RATED},
        "alarms": {name: _value(detectors, {"row": name, "quantity": "alarms at rate"}) for name in RATED},
        "fell": {case: fell for case, (fell, _) in falls.items()},
        "walks": {case: walks for case, (_, walks) in falls.items()},
    }


def found_values(results: Path) -> dict[str, object]:
    """Return what the page of findings takes beside the README's values, by name.

    Raises:
        DataError: a table or a row is missing, or is not as a sentence says.
    """
    peaks = read_texts(results / "peaks.csv")
    hits = read_texts(results / "table_11.csv")
    changed = read_texts(results / "changed.csv")
    detectors = read_texts(results / "detectors.csv")
    limbs = read_texts(results / "limbs.csv")
    part: dict[str, dict[str, float]] = {}
    for limb, name in LIMBS.items():
        part[limb] = {method: _value(limbs, {"row": name, "quantity": method}) for method in COMPARED}
    return {
        "shown": {name: _value(peaks, {**HIT, "method": name}) for name in UNDER_HITS},
        "late": {name: _value(peaks, {**HIT, "metric": "rise_delay", "method": name}) for name in UNDER_HITS},
        "hit": {name: _value(hits, {**HIT_ERROR, "method": name}) for name in ("zero", *UNDER_HITS)},
        "changed": {name: _value(changed, {"level": level, **CHANGED_WALK}) for name, level in CHANGED.items()},
        "part": part,
        "least": float(_row(detectors, {"row": RATED[0], "quantity": "found at rate"})["low"]),
    }


def shown_in_trial() -> dict[str, float]:
    """Return method -> share of a hit [-], over the robots of a trial, that networks show which learn as the run's."""
    data, way = AS_THE_RUN
    shares = by_robot(read_why(EXPLAINED), SHARE_OF_HIT)
    shown: dict[str, float] = {}
    for method in (MOB_NET, NO_SENSOR):
        robots = shares[data, method, way]
        shown[method] = sum(robots.values()) / len(robots)
    return shown


def _holds(template: Path, verdicts: Mapping[str, str], claim: str, *said: str) -> str:
    """Return no text; a DataError where a claim is gone, or has none of the verdicts that a sentence says."""
    if claim not in verdicts:
        raise DataError(f"claim {claim} is missing, of which {template} tells")
    if verdicts[claim] not in said:
        raise DataError(f"claim {claim}: {template} says {' or '.join(map(repr, said))}, and it is {verdicts[claim]!r}")
    return ""


def _needs(template: Path, truth: bool, sentence: str) -> str:
    """Return no text; a DataError where a sentence does not hold."""
    if not truth:
        raise DataError(f"{template} says that {sentence}, and it is otherwise")
    return ""


def falls_of(results: Path) -> dict[str, tuple[int, int]]:
    """Return case and detector -> walks that end in a fall, and all walks: of reactions that are not held back."""
    falls: dict[str, tuple[int, int]] = {}
    for row in read_texts(results / "safety.csv"):
        # Rows with a waiting time are of reactions that wait on purpose (Figure 16).
        if row["measure"] == "falls" and not float(row["wait_s"]):
            walks = int(row["walks"])
            falls[f"{row['case']} {row['detector']}"] = (round(float(row["value"]) * walks), walks)
    return falls


def scales(results: Path) -> str:
    """Return the table of what each scale takes; that of the published run has its core-hours, and how long it took.

    Raises:
        DataError: the account of the run, or the note of its rates, is missing or damaged.
    """
    rates = _rates(results)
    account = results / "compute.md"
    elapsed = ELAPSED.search(read_text(account))
    if elapsed is None:
        raise DataError(f"{account}: the time of the run is missing, of which the guide tells")
    lines = [["scale", "what it is", "two cores", "core-hours", "memory", "disk"], ["---"] * 2 + ["---:"] * 4]
    for scale, text, time, core_hours, memory, disk in SCALES:
        if scale == rates.scale:
            took = f"{float(elapsed['hours']):.1f} h in the published run, which had {elapsed['load']} % of two cores"
            time, core_hours = f"{rates.core_h / CORES:.1f} h on idle cores; {took}", f"{rates.core_h:.1f}"
        elif not time:
            core_h, two_cores_h = machines.hours_of(read_text(machines.PAGE), scale)
            time, core_hours = f"{two_cores_h / HOURS_OF_A_DAY:.0f} days", f"{core_h:.0f}"
        lines.append([f"`{scale}`", text, time, core_hours, memory, disk])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _value(rows: Sequence[Row], place: Row) -> float:
    """Return the number of the row of a place; a DataError where there is none."""
    return float(_row(rows, place)["value"])


def _row(rows: Sequence[Row], place: Row) -> Row:
    """Return the row of a place; a DataError where there is none."""
    for row in rows:
        if place.items() <= row.items():
            return row
    raise DataError(f"{', '.join(place.values())}: this row is missing, of which the README tells")
