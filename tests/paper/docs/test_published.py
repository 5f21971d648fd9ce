"""What is published agrees with itself: verdicts with their intervals and the claims of today, words with numbers."""

import csv
import gzip
import re
import zlib
from pathlib import Path

import pytest

from experiments.evaluation.measure.claims.verdicts import NO_CAUSE
from experiments.intervals.bounds import apart, within
from experiments.settings.load import load_settings
from experiments.settings.verdicts import DESCRIPTION, NOT_MEASURED, NOT_PRINTED, NOT_REPRODUCED, OPEN, OURS, SIGN_ONLY
from experiments.site.judge_again import judged_again
from mobnet.core.rows import read_texts

ROOT = Path(__file__).parents[3]
RESULTS = ROOT / "docs" / "results"
MAIN = (ROOT / "paper" / "main.tex").read_text()
TEMPLATES = ("README.md.j2", "docs/found.md.j2")
FIELD = re.compile(r"\{\{.*?\}\}|\{%.*?%\}", re.DOTALL)
# Numbers that the templates' own sentences may have: no results. Years, versions and names are none either.
SAID = {
    "3": "GB that the packages take", "30": "% more friction of changed robots",
    "2024": "year", "2026": "year", "0.5.0": "version", "0.6.0": "version", "10.1177/02783649241260428": "DOI",
    "2402.11221v1": "preprint",
}  # fmt: skip
# How many runs decide an open claim: of numbers with six digits it may be one more or less than of the run's own.
COUNT = re.compile(r"\b\d+(?= (?:robots|networks|walks|independent trials)\b)")
PARTS = {
    "abstract": (r"\begin{abstract}", r"\end{abstract}"),
    "conclusion": (r"\section{Conclusion", r"\label{end:main}"),
}


def test_published_verdicts_are_those_of_the_claims_of_today() -> None:
    settings = load_settings(ROOT / "configs")
    published = {row["claim"]: row for row in read_texts(RESULTS / "claims.csv")}
    again = judged_again(settings, RESULTS)
    assert list(published) == again["claim"].tolist()
    for claim in again.to_dict("records"):
        row = published[claim["claim"]]
        for name in ("size", "sign", "verdict", "score", "cause", "beyond_reach", "quantity"):
            assert row[name] == claim[name], (claim["claim"], name)
        assert COUNT.sub("#", row["remark"]) == COUNT.sub("#", claim["remark"])
        for then, now in zip(COUNT.findall(row["remark"]), COUNT.findall(claim["remark"]), strict=True):
            assert abs(int(then) - int(now)) <= 1, (claim["claim"], then, now)


def test_a_count_of_a_remark_is_that_of_runs_that_decide() -> None:
    remark = "Open: if the number stays, 5 robots (here 3) decide the size; 1.3 times as much data decides the sign."
    assert COUNT.findall(remark) == ["5"]


@pytest.mark.parametrize("row", read_texts(RESULTS / "claims.csv"), ids=lambda row: row["claim"])
def test_no_published_claim_is_open_or_refuted_without_a_remark(row: dict[str, str]) -> None:
    """What is open says what would decide it; what is refuted has a number as its cause, or that none is found."""
    if row["verdict"] in (NOT_REPRODUCED, SIGN_ONLY):
        assert row["remark"] in (NO_CAUSE, f"Cause: {row['cause']}")
    elif row["verdict"] == DESCRIPTION:
        assert row["remark"].startswith(("Not counted as reproduced: ", "Described, not judged: "))
    elif OPEN in (row["size"], row["sign"]):
        assert row["remark"].startswith("Open: ")
        assert "decide" in row["remark"]
    else:
        assert bool(row["remark"]) == (row["verdict"] == NOT_MEASURED)
    text = (RESULTS / "claims.md").read_text()
    assert row["remark"] in text


def bounds(row: dict[str, str], low: str, high: str) -> tuple[float | None, float | None]:
    """Return a range or an interval of a row of claims.csv; None is no end."""
    first, last = (float(row[name]) if row[name] else None for name in (low, high))
    return first, last


@pytest.mark.parametrize("row", read_texts(RESULTS / "claims.csv"), ids=lambda row: row["claim"])
def test_a_published_verdict_is_on_the_side_of_its_interval(row: dict[str, str]) -> None:
    """No `same` with an interval on the other side, no `open` with one wholly outside, no own claim as the paper's."""
    for verdict, ends, value, good, bad in (
        ("size", ("from", "to"), ("low", "high"), "inside", "outside"),
        ("sign", ("sign_from", "sign_to"), ("sign_low", "sign_high"), "same", "opposite"),
    ):
        held, (low, high) = bounds(row, *ends), bounds(row, *value)
        if row[verdict] and low is not None and high is not None:
            is_within, is_apart = within((low, high), held), apart((low, high), held)
            assert row[verdict] == (good if is_within else bad if is_apart else "open")
    assert (row["score"] == OURS) == (row["printed"] == NOT_PRINTED)
    assert row["score"] != OURS or not row["published"]


@pytest.mark.parametrize("template", TEMPLATES)
def test_a_template_types_no_number_of_a_result(template: str) -> None:
    prose = FIELD.sub("", (ROOT / template).read_text())
    lines = [line for line in prose.splitlines() if not line.startswith("    ")]
    text = re.sub(r"`[^`]*`|\[note \d+\]|\([^)]*\.md[^)]*\)|\(http[^)]*\)", "", "\n".join(lines))
    found = set(re.findall(r"(?<![\w.-])\d[\w./-]*\w|(?<![\w.-])\d", text))
    assert {number for number in found if number not in SAID} == set()


@pytest.mark.parametrize("part", PARTS)
def test_abstract_and_conclusion_type_no_number(part: str) -> None:
    """Every number there is a macro; names such as a unit's power hold none."""
    start, end = PARTS[part]
    text = MAIN[MAIN.index(start) : MAIN.index(end)]
    text = re.sub(r"\\[a-z]+(?:\{[^{}]*\})+|\\[a-zA-Z]+", " ", text)
    assert re.findall(r"\d+", text) == []


def test_the_walks_that_figure_22_shows_falling_are_counted() -> None:
    """It shows a fall of each case that has one; caption and text quote the share of falls."""
    shares = {row["case"]: float(row["value"]) for row in read_texts(RESULTS / "safety.csv")
              if (row["detector"], row["thresholds"], row["wait_s"], row["measure"])
              == ("MOB-Net-pushed-ratio", "reaction", "0", "falls")}  # fmt: skip
    text = gzip.decompress((RESULTS / "figures/figure_22.csv.gz").read_bytes()).decode()
    rows = list(csv.DictReader(text.splitlines()))
    drawn = {row["case"] for row in rows}
    assert drawn == {"cart", "door"}
    assert {row["case"] for row in rows if row["fell"] == "1"} == {case for case in drawn if shares[case] > 0.0}
    assert r"\cellshare{safety@door@MOB-Net-pushed-ratio@reaction@0@falls}" in MAIN
    caption = (ROOT / "workflow/report/figures/figure_22.rst").read_text()
    assert 'cellshare("safety@door@MOB-Net-pushed-ratio@reaction@0@falls")' in caption
    assert "the title counts all walks of the case" in " ".join(caption.split())


def test_pushes_of_the_foot_are_few_in_both_training_sets_and_in_nearly_every_swing_of_the_pushed_one() -> None:
    """Of which captions and the text tell: the same with and without random torques; a pause of less than two steps."""
    settings = load_settings(ROOT / "configs")
    longest_s = max(settings.commands.duration_s)

    def pauses(name: str) -> list[tuple[float, float]]:
        pushes = [settings.pushes[push] for push in settings.scenarios[name].pushes]
        return [push.pause_s for push in pushes if push.pause_s and (push.during or "").endswith("swing")]

    assert settings.scenarios["robot_walk"].pushes == settings.scenarios["robot_walk_plain"].pushes
    assert pauses("robot_walk") == [(2.0, 8.0)] * 2
    assert min(longest for _, longest in pauses("robot_walk_pushed")) < 2.0 * longest_s
    first = settings.pushes["left_foot"]
    assert first.force_n == (10.0, 60.0)
    assert r"pushed with 10 to 60\,N every 2 to 8\,s" in " ".join(MAIN.split())


# Rows of the table in the note on training -> cells of docs/trials/factorial.csv: effect, torque, pushes, commands.
TAUGHT = {
    "random torque, joystick and no pushes": ("without / with random torque", "", "none", "joystick"),
    "random torque, varied commands and no pushes": ("without / with random torque", "", "none", "varied"),
    "random torque, varied commands and pushes": ("without / with random torque", "", "often", "varied"),
    "random torque, over all levels": ("without / with random torque", "", "", ""),
    "pushes, over all levels": ("without / with pushes", "", "", ""),
    "variety of commands, over all levels": ("joystick / varied commands", "", "", ""),
    "the day of the tests": ("another day / same day", "", "", ""),
}


def test_the_note_on_training_has_the_numbers_of_the_trial_of_training_data() -> None:
    note = (ROOT / "docs" / "notes" / "training.md").read_text()
    rows = read_texts(ROOT / "docs" / "trials" / "factorial.csv")
    found: dict[tuple[str, ...], str] = {}
    values: dict[tuple[str, ...], float] = {}
    shares: dict[str, list[float]] = {}
    for row in rows:
        key = tuple(row[name] for name in ("name", "random_torque_nm", "pushes", "commands", "measure"))
        if row["part"] == "effects":
            values[key] = float(row["value"])
            found[key] = f"{float(row['value']):.2f} [{float(row['low']):.2f}, {float(row['high']):.2f}]"
        elif row["pushes"] and row["measure"] == "share" and row["robot"] == "all":
            shares.setdefault(row["pushes"], []).append(float(row["value"]))
    for name, of in TAUGHT.items():
        assert f"| {name} | {found[*of, 'walking']} | {found[*of, 'hits']} |" in note
    assert max(shares["none"]) < 0.405  # two fifths
    assert min(shares["often"]) > 0.66  # two thirds
    causes = ("random torque, joystick and no pushes", "the day of the tests")
    both = [values[*TAUGHT[name], "walking"] for name in causes]
    assert f"would make {both[0]:.2f} x {both[1]:.2f} = {both[0] * both[1]:.2f}" in " ".join(note.split())


def test_a_publication_makes_the_repository_little_larger() -> None:
    """SVG and PDF of figures are drawn from the numbers here; the film of a walk belongs to the guide.

    The paper, which is there to be read without a run, has a bound of its own.
    """
    packed = 0
    paper = RESULTS / "paper.pdf"
    for folder in (RESULTS, ROOT / "docs/demo"):
        for path in folder.rglob("*"):
            if path.is_file() and path.name not in (paper.name, "walk.webp"):
                assert path.suffix not in (".svg", ".gif", ".mp4"), path
                packed += len(zlib.compress(path.read_bytes()))
    assert 2e6 < packed < 8.5e6
    assert paper.stat().st_size < 4e6
