"""The README's blocks come from the published CSVs, and its own words are few."""

import re
from pathlib import Path

import pytest

from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.report.readme import COLUMNS, FELT, FILMED, FINDINGS, HIT, RATED, SAID, blocks, headline
from experiments.settings.load import load_settings
from mobnet.core.columns import (
    CLAIMED,
    HELD,
    JUDGED_WITH,
    NEAR,
    NOT_MEASURED,
    NOT_REPRODUCED,
    OURS,
    PAPER,
    PRINTED,
    REPRODUCED_WITH,
    SHUFFLED,
    STAND_INS,
    UNEXPLAINED,
    VERDICTS,
)
from mobnet.core.errors import DataError
from mobnet.core.files import write_json
from mobnet.core.rows import read_texts

README = Path(__file__).parents[4] / "README.md"
PLACE = ("scenario", "level", "joint", "metric", "method", "value", "published")
CLAIMS = sorted({name for text in FINDINGS for name in re.findall(r"c\[([^]]*)\]", text)})


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Published results: the error of a method is its place in the list, and that of MOB is printed."""
    methods = ["zero", "MOB", "MOB-fric-load", "MOB-fric-dahl", "MOB-Net", "FTS-e2e"]
    for _, tables, place in COLUMNS:
        cells = [place.get(name, "robots") for name in PLACE[:4]]
        rows = [(*cells, method, float(k), 9.0 if method == "MOB" else None) for k, method in enumerate(methods)]
        write_csv(tmp_path / f"{tables[0]}.csv", PLACE, [("other", *rows[0][1:]), *rows])
        for further in tables[1:]:
            write_csv(tmp_path / f"{further}.csv", PLACE, [(*cells, FILMED, 6.0, None)])
    write_csv(tmp_path / "claims.csv", ("claim", "value", "published", "verdict"), [claim_of(name) for name in CLAIMS])
    falls = [
        (case, detector, wait_s, "falls", share, 20)
        for case in ("foot", "knee", "door")
        for detector, wait_s, share in (
            ("MOB-Net-pushed-ratio", 0.0, 0.05),
            ("MOB-Net-pushed-ratio", 0.4, 0.9),
            ("none", 0.0, 1.0),
        )
    ]
    write_csv(tmp_path / "safety.csv", ("case", "detector", "wait_s", "measure", "value", "walks"), falls)
    outcomes = [*VERDICTS, "all", UNEXPLAINED, PRINTED, HELD, NEAR]
    outcomes += [text.format(name) for name in STAND_INS for text in (JUDGED_WITH, REPRODUCED_WITH)]
    counts = [
        (score, name, 10 * k + j, k, 2 * k) for j, score in enumerate((PAPER, OURS)) for k, name in enumerate(outcomes)
    ]
    write_csv(tmp_path / "claims_summary.csv", CLAIMED, counts)
    detected: list[tuple[str, str, float]] = []
    for name in RATED:
        detected += [(name, "found at rate", 0.5), (name, "alarms at rate", 2.5)]
    write_csv(tmp_path / "detectors.csv", ("row", "quantity", "value"), detected)
    hit = ("scenario", "level", "limb", "joint", "method", "metric", "value")
    felt = [
        (*HIT.values(), name, metric, value)
        for name in FELT
        for metric, value in (("push_share", 0.4 if name == "MOB-Net" else 0.75), ("rise_delay", 20.0))
    ]
    write_csv(tmp_path / "peaks.csv", hit, felt)
    (tmp_path / "compute.md").write_text(
        "| all jobs | 2 | 6.00 | 8.00 | 75 | 9 |\n| elapsed (cores: 2) |  |  | 4.12 | 73 |  |\n"
    )
    note = {"processor": "made-up", "scale": "default", "core_h": 6.04, "peak_mib": 9.0, "kinds": {}}
    write_json(tmp_path / "rates.json", note)
    return tmp_path


def claim_of(name: str, verdict: str | None = None) -> tuple[str, float, None, str]:
    """Return the row of a claim, with a verdict or with the one that sentences say."""
    return name, 0.5, None, verdict or SAID.get(name, NOT_REPRODUCED)


def test_the_row_of_the_published_scale_has_what_its_run_took(results: Path) -> None:
    rows = {line.split("`")[1]: line for line in blocks(results)["scales"].splitlines()[2:]}
    assert list(rows) == list(load_settings().scales)
    assert "| 3.0 h if idle; the published run, with 73 % of their time, took 4.1 h | 6.0 |" in rows["default"]
    assert all("published run" not in row for scale, row in rows.items() if scale != "default")


def test_an_account_without_the_time_of_the_run_is_told(results: Path) -> None:
    (results / "compute.md").write_text("| all jobs | 2 | 6.00 | 8.00 | 75 | 9 |\n")
    with pytest.raises(DataError, match=r"compute\.md: the time of the run is missing"):
        blocks(results)


def test_no_other_document_says_what_the_published_run_took() -> None:
    """One place says it, and is made of the run's own account."""
    told = r"\d core-hours|took \d[\d.]* h"
    assert re.findall(told, (README.parent / "docs/guide.md").read_text()) == []
    text = re.sub(r"<!-- (\w+) -->.*?<!-- /\1 -->", "", README.read_text(), flags=re.DOTALL)
    assert re.findall(told, text) == []


def test_errors_are_beside_those_of_the_original_and_a_dash_where_no_method_ran(results: Path) -> None:
    lines = blocks(results)["headline"].splitlines()
    assert lines[2] == "| estimate nothing | 0.0 | 0.0 | 0.0 |"
    assert lines[3] == "| momentum observer | 1.0 (9.0) | 1.0 (9.0) | 1.0 (9.0) |"
    assert lines[5] == "| MOB-Net | 4.0 | 4.0 | 4.0 |"
    assert lines[6] == f"| {FILMED}, trained with a push in nearly every swing | - | 6.0 | - |"


def test_our_best_formula_is_named_in_each_column(results: Path) -> None:
    _, (table, *_), place = COLUMNS[1]
    cells = [place.get(name, "robots") for name in PLACE[:4]]
    rows = [(*cells, "MOB-fric-load", 7.0, None), (*cells, "MOB-fric-dahl", 6.0, None)]
    write_csv(results / f"{table}.csv", PLACE, rows)
    lines = headline(results).splitlines()
    assert lines[4] == "| with our best friction formula | 2.0 | 6.0 | 2.0 |"
    assert lines[-1].endswith("seen: friction that grows with the load, then friction with a memory.")


def test_the_first_sentence_has_the_errors_on_the_robots_and_the_smaller_one_of_two_formulas(results: Path) -> None:
    made = blocks(results)
    assert f"{FILMED}'s error on a leg is 6.0 N m in walking and - under a hit" in made["found"]
    assert "formula 2.0 and 2.0, of no estimate 0.0 and 0.0" in made["found"]
    assert made["tested"].startswith("Of 70 statements of the original")
    assert "50 are reproduced (sizes within a factor of two) and 0 are not" in made["tested"]
    assert (
        "no estimate reproduces 130, the observer 150, MOB-Net half a walk late 170." in made["tested"]
    )  # of made-up counts


def test_statements_of_the_original_and_our_own_are_counted_apart(results: Path) -> None:
    text = blocks(results)["claims_summary"]
    assert "| not reproduced | 0 | 0 | 1 |" in text
    assert "| reproduced | 50 | 5 | 51 |" in text
    assert "Of 10 statements of the original that fail in size or sign, 80 do so" in text
    assert "Of 18 printed numbers 20 lie in our interval" in text


def test_a_run_without_a_control_tells_of_none(results: Path) -> None:
    counted = read_texts(results / "claims_summary.csv")
    for row in counted:
        if row["outcome"] == JUDGED_WITH.format(SHUFFLED):
            row["statements"] = "0"
    write_csv(results / "claims_summary.csv", CLAIMED, [tuple(row.values()) for row in counted])
    assert "no estimate reproduces" not in blocks(results)["tested"]


def test_a_share_that_a_sentence_calls_small_is_refused_where_it_is_not(results: Path) -> None:
    text = (results / "peaks.csv").read_text().replace("0.4", "0.9")
    (results / "peaks.csv").write_text(text)
    with pytest.raises(DataError, match="MOB-Net shows 90% of a hit: the README says otherwise"):
        blocks(results)


@pytest.mark.parametrize("statements", [0, 3])
def test_a_verdict_that_says_nothing_has_a_row_where_a_statement_has_it(results: Path, statements: int) -> None:
    counted = read_texts(results / "claims_summary.csv")
    for row in counted:
        if row["outcome"] == NOT_MEASURED:
            row["statements"] = str(statements)
    write_csv(results / "claims_summary.csv", CLAIMED, [tuple(row.values()) for row in counted])
    assert ("not measured" in blocks(results)["claims_summary"]) == bool(statements)


def test_findings_have_the_numbers_of_claims_and_tables_and_the_falls_of_reactions_that_do_not_wait(
    results: Path,
) -> None:
    text = blocks(results)["findings"]
    assert "Without random torques in training MOB-Net's error is 0.50 times as large in walking (original nan:" in text
    assert "without them its error there is 1.65 times as large, without random torques 0.89 times" in text
    assert "1 of 20 end in a fall with this reaction and 20 of 20 without it" in text
    assert "(FTS-e2e) has 5.0 N m on that leg" in text
    assert "with a memory 75%, half of it 20 ms late" in text
    assert "finds 50% of the collisions of a swinging leg at 2.5 false alarms" in text
    assert len(text.splitlines()) == len(FINDINGS)


def test_a_claim_that_is_gone_is_told(results: Path) -> None:
    write_csv(
        results / "claims.csv", ("claim", "value", "published", "verdict"), [claim_of(name) for name in CLAIMS[1:]]
    )
    with pytest.raises(DataError, match=f"{CLAIMS[0]}.*README"):
        blocks(results)


def test_a_verdict_that_turned_is_told(results: Path) -> None:
    """A sentence says that random torques are not reproduced."""
    rows = [claim_of(name, "open" if name == "rte-swing" else None) for name in CLAIMS]
    write_csv(results / "claims.csv", ("claim", "value", "published", "verdict"), rows)
    with pytest.raises(DataError, match="claim rte-swing: the README says 'not reproduced', and it is 'open'"):
        blocks(results)


def test_a_number_of_a_table_that_is_gone_is_told(results: Path) -> None:
    write_csv(results / "detectors.csv", ("row", "quantity", "value"), [("MOB", "found", 1.0)])
    with pytest.raises(
        DataError, match="MOB-Net-pushed-ratio, found at rate: this row is missing, of which the README tells"
    ):
        blocks(results)


def test_the_words_of_the_readme_are_few() -> None:
    """Those beside tables, commands and entries of BibTeX, blocks included: a reader takes them in at one sitting."""
    text = re.sub(r"<!--.*?-->", "", README.read_text())
    prose = [line for line in text.splitlines() if not line.startswith(("|", "    "))]
    assert len(" ".join(prose).split()) <= 900


def test_what_a_stranger_sees_first_is_the_finding_the_original_the_commands_and_a_picture_with_an_answer() -> None:
    """In this order and in few lines, so that all of it is on the first screen; the table comes next."""
    text = README.read_text()
    found = ("\n**", "](https://doi.org/", "    ./reproduce demo", "    ./reproduce all", "    ./reproduce test",
             "](docs/results/push.webp)", "\n| error on a walking leg")  # fmt: skip
    places = [text.index(words) for words in found]
    assert places == sorted(places)
    before = re.sub(r"<!--.*?-->|\(http[^)]*\)", "", text[: places[-2]])
    prose = [line for line in before.splitlines() if not line.startswith(("    ", "!["))]
    assert len(" ".join(prose).split()) <= 90
    rows = [line for line in blocks(README.parent / "docs/results")["headline"].splitlines() if line.startswith("|")]
    assert 4 <= len(rows) - 2 <= 5
    assert all(row.count("|") == 5 for row in rows)
    assert rows[2].startswith("| estimate nothing ")  # beside every error


def test_every_word_of_the_findings_that_a_stranger_does_not_know_is_explained_before_or_in_the_glossary() -> None:
    """`reaction` and methods are said in words where they come first."""
    text = " ".join(README.read_text().split())
    for word, told in (
        ("MOB-Net-pushed's torque", "MOB-Net-pushed, trained with a push in nearly every swing"),
        ("this reaction", "After an alarm the robot steps back"),
        ("FTS-e2e", "network that learns the torque itself (FTS-e2e)"),
        ("with a memory", "Our best formula"),
    ):
        assert told in text
        assert text.index(told) < text.index(word) + len(told)
    glossary = (README.parent / "docs/glossary.md").read_text()
    for word in ("ratio detector", "reaction", "random torque", "knee hit", "FTS-e2e", "friction formula", "statement"):
        assert re.search(rf"^\| [^|]*{word}", glossary, re.MULTILINE), word
