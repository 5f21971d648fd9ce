"""What the README shows of the published results: made from their CSVs, so that none of their numbers is typed."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace

from experiments.plan.prices import RATES, RatesNote
from mobnet.core.columns import (
    CLAIMED,
    HELD,
    JUDGED_WITH,
    NEAR,
    NOT_MEASURED,
    NOT_REPRODUCED,
    OPEN,
    OURS,
    PAPER,
    PRINTED,
    SHUFFLED,
    SIGN_ONLY,
    UNEXPLAINED,
    VERDICTS,
)
from mobnet.core.errors import DataError
from mobnet.core.files import read_text
from mobnet.core.notes import read_note
from mobnet.core.rows import read_texts

AVERAGE = {"metric": "rmse", "joint": "avg"}
FORWARD = {"scenario": "forward_walk", "level": "all_uncertainty", **AVERAGE}
WALK = {"scenario": "walk_test", **AVERAGE}
UNDER_HITS = {"scenario": "knee_swing", "joint": "avg", "metric": "+".join(f"rmse_push_{k}" for k in range(1, 5))}
# title, tables that have its numbers, the first of them first, and the place of these in each
COLUMNS = (
    ("friction by the original's law", ("table_05",), FORWARD),
    ("robots with unknown gears", ("table_07", "table_10"), WALK),
    ("robots, their swinging knee hit", ("table_11",), UNDER_HITS),
)
ROBOTS, HITS = COLUMNS[1:]
FILMED = "MOB-Net-pushed"  # the network of the film of the first screen, of which its first sentence tells
BEST = "with our best friction formula"
FORMULAS = {"MOB-fric-load": "friction that grows with the load", "MOB-fric-dahl": "friction with a memory"}
METHODS = {  # what a row is called -> its method, or those of which it shows the best one in each column
    "estimate nothing": ("zero",),
    "momentum observer": ("MOB",),
    BEST: tuple(FORMULAS),
    "MOB-Net": ("MOB-Net",),
    f"{FILMED}, trained with a push in nearly every swing": (FILMED,),
}
# What was found: errors on the robots [N m] in walking (e) and under a hit (h) by method, those of our best formula
# there, and counts of verdicts of statements of the original (n).
FOUND = (
    "**A walking humanoid feels a push on any joint without a force sensor there: in simulation, with gears that no "
    "method knows, {filmed}'s error on a leg is {e[filmed]} N m in walking and {h[filmed]} under a hit, that of our "
    "best friction formula {best_walk} and {best_hit}, of no estimate {e[zero]} and {h[zero]}.**\n"
)
TESTED = (
    "Of {n[all]} statements of the original {n[reproduced]} are reproduced (sizes within a factor of two) and "
    "{n[not reproduced]} are not; others hold in sign, are open or too weak to count.{control}\n"
)
# Of a run that judged methods which know nothing as if they were MOB-Net; runs before 0.7.0 did not.
CONTROL = (
    " In a network's place no estimate reproduces {n[reproduced with zero]}, the observer "
    "{n[reproduced with MOB]}, MOB-Net half a walk late {n[reproduced with MOB-Net-shuffled]}."
)
# What each scale takes: scale, what it is, time on two cores, core-hours, memory, disk. The published run says what its
# own took.
SCALES = (
    ("smoke", "seconds of walking; its numbers mean nothing", "12 to 17 min", "0.6", "0.5 GiB", "1.1 GiB"),
    ("quick", "every item once, shorter walks", "50 min", "1.6", "4.2 GiB", "13 GiB"),
    ("default", "the published sizes", "", "", "5.6 GiB", "50 GiB"),
    ("paper", "3.6 million samples, 200 epochs", "12 days", "580", "21 GiB", "340 GiB"),
)
CORES = 2
# Wall time [h] of the whole run in compute.md, and the share of the cores' time that it had [%].
ELAPSED = re.compile(r"^\| elapsed [^|]*\|[^|]*\|[^|]*\| (?P<hours>[\d.]+) \| (?P<load>\d+) \|", re.MULTILINE)
# Sentences with numbers of claims.csv (c), falls of safety.csv (s, by case and detector), numbers of other tables (t),
# errors on the robots (e) and ratios of errors under hits in a trial (f).
FINDINGS = (
    "**Formula against network.** On robots with unknown gears the best friction formula has "
    "{c[model-walk].value:.1f} times MOB-Net's error on a leg and {c[model-waist].value:.1f} times on the waist; on "
    "the right arm {c[model-right-arm].value:.1f} times leaves open which is better. A network that "
    "learns the torque itself (FTS-e2e) has {e[FTS-e2e]} N m on that leg. Of a hit on the swinging knee MOB-Net shows "
    "{t[share MOB-Net]:.0%}, the formula with a memory {t[share MOB-fric-dahl]:.0%}, half of it "
    "{t[late MOB-fric-dahl]:.0f} ms late, MOB-Net-pushed {t[share MOB-Net-pushed]:.0%} and "
    "{t[late MOB-Net-pushed]:.0f} ms.",
    "**False alarms.** With thresholds for one false alarm an hour, the ratio of MOB-Net-pushed's torque to its "
    "standard deviation finds {t[found MOB-Net-pushed-ratio]:.0%} of the collisions of a swinging leg at "
    "{t[false MOB-Net-pushed-ratio]:.1f} false alarms an hour, counted in other walks; a friction formula finds "
    "{t[found MOB-fric-load]:.0%} at {t[false MOB-fric-load]:.1f}.",
    "**Random torque.** Without random torques in training MOB-Net's error is {c[rte-walk].value:.2f} times as large "
    "in walking (original {c[rte-walk].published:.2f}: the sign holds, the size does not) and "
    "{c[rte-swing].value:.2f} times in a hit on the swinging knee (original {c[rte-swing].published:.2f}: not "
    "reproduced). In a trial on four robots, pushes teach a network to show a hit: without them its error there is "
    "{f[pushes]:.2f} times as large, without random torques {f[torques]:.2f} times.",
    "**Reaction.** After an alarm the robot steps back. Of walks into a block with the foot, "
    "{s[foot MOB-Net-pushed-ratio].fell} of {s[foot MOB-Net-pushed-ratio].walks} end in a fall with this reaction and "
    "{s[foot none].fell} of {s[foot none].walks} without it; into a bar with the knee, "
    "{s[knee MOB-Net-pushed-ratio].fell} of {s[knee MOB-Net-pushed-ratio].walks} and {s[knee none].fell} of "
    "{s[knee none].walks}.",
)
# Claims whose verdict a sentence names.
SAID = {"rte-walk": SIGN_ONLY, "rte-swing": NOT_REPRODUCED, "model-right-arm": OPEN}
# Who shows less than half of a hit, as a sentence says; the others show more.
HALF = 0.5
LESS_THAN_HALF = ("MOB-Net",)
HIT = {"scenario": "knee_swing", "level": "robots", "limb": "LL", "joint": "avg"}
# What the data of networks teach, a trial that is kept: each effect over all levels of the others.
TAUGHT = Path("docs/trials/factorial.csv")
EFFECTS = {"pushes": "without / with pushes", "torques": "without / with random torque"}
ON_HITS = {"part": "effects", "random_torque_nm": "", "pushes": "", "commands": "", "measure": "hits"}
RATED = ("MOB-Net-pushed-ratio", "MOB-fric-load")
FELT = ("MOB-fric-dahl", "MOB-Net", "MOB-Net-pushed")
Row = Mapping[str, str]


def blocks(results: Path) -> dict[str, str]:
    """Return block of the README -> its text, from a folder of published results.

    Raises:
        DataError: a table or a row is missing.
    """
    first = {"found": found(results), "headline": headline(results), "tested": tested(results)}
    return {**first, "findings": findings(results), "claims_summary": verdicts(results), "scales": scales(results)}


def found(results: Path) -> str:
    """Return what was found in a sentence with errors on the robots."""
    walk = _errors(results, ROBOTS)
    hit = _errors(results, HITS)
    for errors in (walk, hit):
        errors["filmed"] = errors.get(FILMED, "-")
    return _told(
        FOUND, results, e=walk, h=hit, filmed=FILMED, best_walk=_best_formula(walk), best_hit=_best_formula(hit)
    )


def _best_formula(errors: Mapping[str, str]) -> str:
    """Return the smallest error of our formulas [N m], as text."""
    formulas = [float(errors[method]) for method in METHODS[BEST] if method in errors]
    return f"{min(formulas):.1f}" if formulas else "-"


def tested(results: Path) -> str:
    """Return a sentence with how many statements of the original are reproduced, and how many are not."""
    rows = read_texts(results / "claims_summary.csv", CLAIMED)
    counts = {row["outcome"]: row["statements"] for row in rows if row["score"] == PAPER}
    is_controlled = int(counts[JUDGED_WITH.format(SHUFFLED)]) > 0
    control = _told(CONTROL, results, n=counts) if is_controlled else ""
    return _told(TESTED, results, n=counts, control=control)


def _told(text: str, results: Path, **numbers: object) -> str:
    """Return a text with its numbers; a DataError names the first one that is missing."""
    try:
        return text.format(**numbers)
    except KeyError as missing:
        raise DataError(f"{results}: {missing} is missing, of which the README tells") from missing


def _errors(results: Path, column: tuple[str, Sequence[str], Row] = ROBOTS) -> dict[str, str]:
    """Return method -> its error on the left leg of the robots [N m], as text: in a column of the headline."""
    _, tables, place = column
    rows = _rows(results, tables)
    return {row["method"]: f"{float(row['value']):.1f}" for row in rows if place.items() <= row.items()}


def _rows(results: Path, tables: Sequence[str]) -> list[Row]:
    """Return the rows of tables, one table after another."""
    rows: list[Row] = []
    for table in tables:
        rows += read_texts(results / f"{table}.csv")
    return rows


def verdicts(results: Path) -> str:
    """Return how many statements of the original and of our own have each verdict, and two sentences with counts."""
    rows = read_texts(results / "claims_summary.csv", CLAIMED)
    counts = {(row["score"], row["outcome"]): row for row in rows}
    head = "| Verdict | statements of the original | by first claim | ours |\n"
    lines = [head, "| --- | ---: | ---: | ---: |\n"]
    for verdict in (*VERDICTS, "all"):
        paper = counts[PAPER, verdict]
        ours = counts[OURS, verdict]
        if verdict == NOT_MEASURED and paper["statements"] == ours["statements"] == "0":
            continue  # the one verdict that says nothing of a claim
        lines.append(f"| {verdict} | {paper['statements']} | {paper['firsts']} | {ours['statements']} |\n")
    failed = sum(int(counts[PAPER, verdict]["statements"]) for verdict in (NOT_REPRODUCED, SIGN_ONLY))
    unexplained = counts[PAPER, UNEXPLAINED]["statements"]
    printed, held, near = (counts[PAPER, name]["claims"] for name in (PRINTED, HELD, NEAR))
    said = (
        f"Of {failed} statements of the original that fail in size or sign, {unexplained} do so without a cause.\n"
        f"Of {printed} printed numbers {held} lie in our interval, {near} within a factor of 1.5 of ours.\n"
    )
    return "".join([*lines, "\n", said])


def headline(results: Path) -> str:
    """Return a table of errors in two tests [N m], the original's in parentheses, and which formula is our best one."""
    lines = [["error on a walking leg [N m], ours (original)", *(title for title, *_ in COLUMNS)]]
    lines.append(["---", *["---:"] * len(COLUMNS)])
    named: list[str] = []
    rows = {title: _rows(results, tables) for title, tables, _ in COLUMNS}
    for shown, methods in METHODS.items():
        cells: list[str] = []
        for title, _, place in COLUMNS:
            best = _best(rows[title], place, methods)
            cells.append(_cell(best))
            if shown == BEST and best is not None:
                named.append(FORMULAS[best["method"]])
        lines.append([shown, *cells])
    table = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    formulas = ", then ".join(dict.fromkeys(named))
    told = f"Our best formula, chosen when results had been seen: {formulas}."
    return f"{table}\n{told}\n"


def scales(results: Path) -> str:
    """Return the table of what each scale takes; that of the published run has its core-hours, and how long it took.

    Raises:
        DataError: the account of the run, or the note of its rates, is missing or damaged.
    """
    rates = read_note(results / RATES.name, RatesNote)
    account = results / "compute.md"
    elapsed = ELAPSED.search(read_text(account))
    if elapsed is None:
        raise DataError(f"{account}: the time of the run is missing, of which the README tells")
    lines = [["scale", "what it is", "two cores", "core-hours", "memory", "disk"], ["---"] * 2 + ["---:"] * 4]
    for scale, text, time, core_hours, memory, disk in SCALES:
        if scale == rates.scale:
            took = f"the published run, with {elapsed['load']} % of their time, took {float(elapsed['hours']):.1f} h"
            time, core_hours = f"{rates.core_h / CORES:.1f} h if idle; {took}", f"{rates.core_h:.1f}"
        lines.append([f"`{scale}`", text, time, core_hours, memory, disk])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _best(rows: Sequence[Row], place: Row, methods: Sequence[str]) -> Row | None:
    """Return the row of the smallest error of some methods in a place; None where none of them ran."""
    known = [row for row in rows if row["method"] in methods and row["value"]]
    placed = [row for row in known if place.items() <= row.items()]
    return min(placed, key=lambda row: float(row["value"]), default=None)


def _cell(row: Row | None) -> str:
    """Return the number of a row, and the original's, if it prints one; a dash where no method ran."""
    if row is None:
        return "-"
    published = row["published"]
    return f"{float(row['value']):.1f}" + (f" ({float(published):.1f})" if published else "")


def findings(results: Path) -> str:
    """Return sentences about what differs from the original, and about what it does not have.

    Raises:
        DataError: a claim or a case is missing, or has another verdict than a sentence says.
    """
    rows = {row["claim"]: row for row in read_texts(results / "claims.csv")}
    for claim, verdict in SAID.items():
        if claim in rows and rows[claim]["verdict"] != verdict:
            raise DataError(f"claim {claim}: the README says {verdict!r}, and it is {rows[claim]['verdict']!r}")
    claims = {claim: _numbers(row, "value", "published") for claim, row in rows.items()}
    # Rows with a waiting time are of reactions that are held back on purpose (Figure 16).
    falls = {
        f"{row['case']} {row['detector']}": SimpleNamespace(
            fell=round(float(row["value"]) * int(row["walks"])), walks=row["walks"]
        )
        for row in read_texts(results / "safety.csv")
        if row["measure"] == "falls" and not float(row["wait_s"])
    }
    taught = read_texts(TAUGHT)
    effects = {short: _value(taught, {"name": name, **ON_HITS}) for short, name in EFFECTS.items()}
    numbers = {"c": claims, "s": falls, "t": _of_tables(results), "e": _errors(results), "f": effects}
    return "".join(f"* {_told(text, results, **numbers)}\n" for text in FINDINGS)


def _of_tables(results: Path) -> dict[str, float]:
    """Return what findings tell of detectors and of a hit: shares [-], delays [ms] and false alarms [1/h]."""
    detectors = read_texts(results / "detectors.csv")
    peaks = read_texts(results / "peaks.csv")
    told: dict[str, float] = {}
    for name in RATED:
        told[f"found {name}"] = _value(detectors, {"row": name, "quantity": "found at rate"})
        told[f"false {name}"] = _value(detectors, {"row": name, "quantity": "alarms at rate"})
    for name in FELT:
        told[f"share {name}"] = _value(peaks, {**HIT, "method": name, "metric": "push_share"})
        told[f"late {name}"] = _value(peaks, {**HIT, "method": name, "metric": "rise_delay"})
        if (told[f"share {name}"] < HALF) != (name in LESS_THAN_HALF):
            raise DataError(f"{name} shows {told[f'share {name}']:.0%} of a hit: the README says otherwise")
    return told


def _value(rows: Sequence[Row], place: Row) -> float:
    """Return the number of the row of a place; a DataError where there is none."""
    for row in rows:
        if place.items() <= row.items():
            return float(row["value"])
    raise DataError(f"{', '.join(place.values())}: this row is missing, of which the README tells")


def _numbers(row: Row, *names: str) -> SimpleNamespace:
    """Return the numbers of a row; not a number where a cell is empty."""
    return SimpleNamespace(**{name: float(row[name] or "nan") for name in names})
