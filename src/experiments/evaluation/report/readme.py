"""What the README shows of the published results: made from their CSVs, so that none of their numbers is typed."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace

from experiments.evaluation.report.rates import RATES, RatesNote
from mobnet.core.columns import (
    CLAIMED,
    HELD,
    NEAR,
    NOT_REPRODUCED,
    OURS,
    PAPER,
    PRINTED,
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
HAND = {"scenario": "hand_wrench", "metric": "rmse_pushed", "joint": "avg W+RA"}
COLUMNS = (  # title, table, place of its numbers
    ("left leg, walking ahead, plant of section 5.1", "table_05", FORWARD),
    ("left leg, random walking, surrogate robots", "table_07", WALK),
    ("waist and right arm, wrench at the hand, surrogate robots", "table_08", HAND),
)
METHODS = {
    "estimate nothing": "zero",
    "momentum observer (MOB)": "MOB",
    "MOB with the paper's friction formula": "MOB-fric",
    "MOB with ours: friction that grows with the load": "MOB-fric-load",
    "MOB with ours: the same with a memory": "MOB-fric-dahl",
    "FTS-e2e, trained end to end": "FTS-e2e",
    "MOB-Net": "MOB-Net",
}
# What each scale takes: scale, what it is, time on two cores, core-hours, memory, disk. The published run says what its
# own took.
SCALES = (
    (
        "smoke",
        "the whole workflow on seconds of walking; its numbers mean nothing",
        "10 min",
        "0.3",
        "0.5 GiB",
        "1.1 GiB",
    ),
    ("quick", "every item once: one robot, one network of each kind, shorter walks", "1 h", "1.5", "4.4 GiB", "13 GiB"),
    ("default", "the published sizes: three robots, three networks of the left leg", "", "", "4.4 GiB", "60 GiB"),
    ("paper", "the sizes of the paper: 3.6 million samples, 200 epochs", "6 days", "280", "14 GiB", "125 GiB"),
)
CORES = 2
# Wall time [h] of the whole run in compute.md, and the share of the cores' time that it had [%].
ELAPSED = re.compile(r"^\| elapsed [^|]*\|[^|]*\|[^|]*\| (?P<hours>[\d.]+) \| (?P<load>\d+) \|", re.MULTILINE)
# Sentences with numbers of claims.csv (c) and falls of safety.csv (s, by case and detector).
FINDINGS = (
    "Training without random torques multiplies MOB-Net's error by {c[rte-walk].value:.2f} in random walking (paper "
    "{c[rte-walk].published:.2f}) and by {c[rte-swing].value:.2f} when the swinging knee is hit (paper "
    "{c[rte-swing].published:.2f}). Both training sets have pushes of the foot in nearly every swing, so this is what "
    "random torques add to such pushes.",
    "On the surrogate robots the best friction formula has {c[model-walk].value:.1f} times the error of MOB-Net on the "
    "left leg, {c[model-right-arm].value:.1f} times on the right arm and {c[model-waist].value:.1f} times on the "
    "waist.",
    "MOB finds {c[found-mob].value:.0%} of the collisions of a swinging leg (paper {c[found-mob].published:.0%}), and "
    "MOB-Net-OR {c[found-or].value:.0%} (paper {c[found-or].published:.0%}).",
    "Of the robots that walk into a block with the foot, {s[foot MOB-Net-ratio].fell} of {s[foot MOB-Net-ratio].walks} "
    "fall with the reaction and {s[foot none].fell} of {s[foot none].walks} without it. Of those that walk into a bar "
    "with the knee, {s[knee MOB-Net-ratio].fell} of {s[knee MOB-Net-ratio].walks} and {s[knee none].fell} of "
    "{s[knee none].walks} fall.",
)
Row = Mapping[str, str]


def blocks(results: Path) -> dict[str, str]:
    """Return block of the README -> its text, from a folder of published results.

    Raises:
        DataError: a table or a row is missing.
    """
    made = {"headline": headline(results), "scales": scales(results)}
    return {**made, "claims_summary": verdicts(results), "findings": findings(results)}


def verdicts(results: Path) -> str:
    """Return how many statements of the paper and of our own have each verdict, and two sentences with counts."""
    rows = read_texts(results / "claims_summary.csv", CLAIMED)
    counts = {(row["score"], row["outcome"]): row for row in rows}
    head = "| Verdict | statements of the paper | of these by their first claim | our own statements |\n"
    lines = [head, "| --- | ---: | ---: | ---: |\n"]
    for verdict in (*VERDICTS, "all"):
        paper = counts[PAPER, verdict]
        ours = counts[OURS, verdict]
        lines.append(f"| {verdict} | {paper['statements']} | {paper['firsts']} | {ours['statements']} |\n")
    failed = sum(int(counts[PAPER, verdict]["statements"]) for verdict in (NOT_REPRODUCED, SIGN_ONLY))
    unexplained = counts[PAPER, UNEXPLAINED]["statements"]
    printed, held, near = (counts[PAPER, name]["claims"] for name in (PRINTED, HELD, NEAR))
    said = (
        f"Of the {failed} statements of the paper whose size or sign is refuted, {unexplained} have a refuted claim\n"
        f"without a cause. Of {printed} claims with a printed number this number lies in our interval in {held}, and\n"
        f"ours within a factor of 1.5 of it in {near}.\n"
    )
    return "".join([*lines, "\n", said])


def headline(results: Path) -> str:
    """Return the table of the errors of methods in three tests [N m], the paper's in parentheses."""
    lines = [["RMSE of the external torque [N m], ours (paper)", *(title for title, *_ in COLUMNS)]]
    lines.append(["---", *["---:"] * len(COLUMNS)])
    tables = {table: read_texts(results / f"{table}.csv") for _, table, _ in COLUMNS}
    for shown, method in METHODS.items():
        cells = [_cell(tables[table], {**place, "method": method}) for _, table, place in COLUMNS]
        lines.append([shown, *cells])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


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


def _cell(rows: Sequence[Row], place: Row) -> str:
    """Return the number of a table in a place, and the paper's, if it prints one; a dash where no method ran."""
    found = next((row for row in rows if place.items() <= row.items()), None)
    if found is None:
        return "-"
    value = found["value"]
    published = found["published"]
    return f"{float(value):.1f}" + (f" ({float(published):.1f})" if published else "")


def findings(results: Path) -> str:
    """Return sentences about what differs from the paper, and about what the paper does not have.

    Raises:
        DataError: a claim or a case is missing.
    """
    claims = {row["claim"]: _numbers(row, "value", "published") for row in read_texts(results / "claims.csv")}
    # Rows with a waiting time are of reactions that are held back on purpose (Figure 16).
    falls = {
        f"{row['case']} {row['detector']}": SimpleNamespace(
            fell=round(float(row["value"]) * int(row["walks"])), walks=row["walks"]
        )
        for row in read_texts(results / "safety.csv")
        if row["measure"] == "falls" and not float(row["wait_s"])
    }
    try:
        return "".join(f"* {text.format(c=claims, s=falls)}\n" for text in FINDINGS)
    except KeyError as missing:
        raise DataError(f"{results}: {missing} is missing, of which the README tells") from missing


def _numbers(row: Row, *names: str) -> SimpleNamespace:
    """Return the numbers of a row; not a number where a cell is empty."""
    return SimpleNamespace(**{name: float(row[name] or "nan") for name in names})
