"""README and page of findings are their templates with numbers of the published CSVs, and their own words are few."""

import re
from pathlib import Path

import pytest

from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.report.headline import COLUMNS, FILMED, best_formulas, headline
from experiments.settings.load import load_settings
from experiments.settings.table_columns import CLAIMED
from experiments.settings.verdicts import (
    JUDGED_WITH,
    NOT_REPRODUCED,
    OURS,
    PAPER,
    REPRODUCED_WITH,
    STAND_INS,
    VERDICTS,
)
from experiments.site.machines import PAGE, hours_of
from experiments.site.readme import (
    CHANGED,
    CHANGED_WALK,
    COMPARED,
    FOUND,
    FOUND_TEMPLATE,
    HIT,
    HIT_ERROR,
    LIMBS,
    MEMORY,
    MOB_NET,
    RATED,
    SHOWN,
    TEMPLATE,
    UNDER_HITS,
    check_told,
    found,
    readme,
    scales,
)
from mobnet.core.errors import DataError
from mobnet.core.files import write_json
from mobnet.core.rows import read_texts

ROOT = Path(__file__).parents[3]
README = ROOT / "README.md"
PLACE = ("scenario", "level", "joint", "metric", "method", "value", "published")
# Claims whose verdict a template says -> the verdict.
SAID, SAID_FOUND = (
    dict(re.findall(r"holds\('([^']*)', '([^']*)'", (ROOT / name).read_text())) for name in (TEMPLATE, FOUND_TEMPLATE)
)
CLAIMS = sorted({*SAID, *re.findall(r"c\['([^']*)'\]", (ROOT / TEMPLATE).read_text())})


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
            ("MOB-Net-pushed-ratio", 0.0, 0.05 if case == "foot" else 0.0),
            ("MOB-Net-pushed-ratio", 0.4, 0.9),
            ("none", 0.0, 0.5 if case == "door" else 1.0),
        )
    ]
    write_csv(tmp_path / "safety.csv", ("case", "detector", "wait_s", "measure", "value", "walks"), falls)
    outcomes = [*VERDICTS, "all"]
    outcomes += [text.format(name) for name in STAND_INS for text in (JUDGED_WITH, REPRODUCED_WITH)]
    counts = [
        (score, name, 10 * k + j, k, 2 * k) for j, score in enumerate((PAPER, OURS)) for k, name in enumerate(outcomes)
    ]
    write_csv(tmp_path / "claims_summary.csv", CLAIMED, counts)
    detected: list[tuple[str, str, float]] = []
    for name in RATED:
        detected += [(name, "found at rate", 0.5), (name, "alarms at rate", 2.5)]
    write_csv(tmp_path / "detectors.csv", ("row", "quantity", "value"), detected)
    shares = [(*HIT.values(), name, 0.4 if name == "MOB-Net" else 0.75) for name in SHOWN]
    write_csv(tmp_path / "peaks.csv", (*HIT, "method", "value"), shares)
    (tmp_path / "compute.md").write_text(
        "| all jobs | 2 | 6.00 | 8.00 | 75 | 9 |\n| elapsed (cores: 2) |  |  | 4.12 | 73 |  |\n"
    )
    note = {"processor": "made-up", "scale": "default", "core_h": 6.04, "peak_mib": 9.0, "kinds": {}}
    write_json(tmp_path / "rates.json", note)
    return tmp_path


def claim_of(name: str, verdict: str | None = None) -> tuple[str, float, None, str]:
    """Return the row of a claim, with a verdict or with the one that sentences say."""
    return name, 1.5 if name == "rte-walk" else 0.5, None, verdict or SAID.get(name, NOT_REPRODUCED)


def made(results: Path) -> str:
    """Return the README of published results on one line."""
    return " ".join(readme(results, ROOT / TEMPLATE).split())


def test_the_row_of_the_published_scale_has_what_its_run_took(results: Path) -> None:
    rows = {line.split("`")[1]: line for line in scales(results).splitlines()[2:]}
    assert list(rows) == list(load_settings().scales)
    assert "| 3.0 h on idle cores; 4.1 h in the published run, which had 73 % of two cores | 6.0 |" in rows["default"]
    assert all("published run" not in row for scale, row in rows.items() if scale != "default")
    assert "3.0 hours on two idle cores" in made(results)


def test_a_scale_that_never_ran_has_the_price_that_the_page_on_clusters_has(results: Path) -> None:
    core_h, two_cores_h = hours_of(PAGE.read_text(), "paper")
    row = next(line for line in scales(results).splitlines() if line.startswith("| `paper`"))
    assert f"| {two_cores_h / 24:.0f} days | {core_h:.0f} |" in row
    with pytest.raises(DataError, match=r"a row of the scale huge is missing"):
        hours_of(PAGE.read_text(), "huge")


def test_an_account_without_the_time_of_the_run_is_told(results: Path) -> None:
    (results / "compute.md").write_text("| all jobs | 2 | 6.00 | 8.00 | 75 | 9 |\n")
    with pytest.raises(DataError, match=r"compute\.md: the time of the run is missing"):
        scales(results)


def test_no_document_types_what_the_published_run_took() -> None:
    """One block of the guide says it, and is made of the run's own account."""
    told = r"\d core-hours|took \d[\d.]* h"
    guide = re.sub(r"<!-- (\w+) -->.*?<!-- /\1 -->", "", (ROOT / "docs/guide.md").read_text(), flags=re.DOTALL)
    assert re.findall(told, guide) == []
    assert re.findall(told, (ROOT / TEMPLATE).read_text()) == []


def test_errors_are_beside_those_of_the_original_and_a_dash_where_no_method_ran(results: Path) -> None:
    lines = headline(results).splitlines()
    assert lines[2] == "| estimate nothing | 0.0 | 0.0 |"
    assert lines[3] == "| momentum observer | 1.0 (9.0) | 1.0 (9.0) |"
    assert lines[5] == "| MOB-Net | 4.0 | 4.0 |"
    assert lines[6] == f"| {FILMED}, trained with a push in nearly every swing | - | 6.0 |"
    assert "\n".join(lines) in readme(results, ROOT / TEMPLATE)


def test_our_best_formula_is_named_in_each_column(results: Path) -> None:
    _, (table, *_), place = COLUMNS[1]
    cells = [place.get(name, "robots") for name in PLACE[:4]]
    rows = [(*cells, "MOB-fric-load", 7.0, None), (*cells, "MOB-fric-dahl", 6.0, None)]
    write_csv(results / f"{table}.csv", PLACE, rows)
    assert headline(results).splitlines()[4] == "| with our best friction formula | 2.0 | 6.0 |"
    assert best_formulas(results) == "friction that grows with the load, then friction with a memory"


def test_the_first_sentence_counts_statements_of_the_original_and_the_others_are_undecided(results: Path) -> None:
    """The counts are made up; those of our own statements are one more each."""
    counted = {row["outcome"]: int(row["statements"]) for row in rows_of(results) if row["score"] == PAPER}
    refuted = counted["not reproduced"] + counted["sign only"]
    rest = counted["all"] - counted["reproduced"] - refuted
    said = (
        f"judged {counted['all']} of their statements: {counted['reproduced']} are reproduced (sizes within a factor "
        f"of two), {refuted} are refuted in size or sign, {rest} are undecided."
    )
    assert said in made(results)


def rows_of(results: Path) -> list[dict[str, str]]:
    """Return the counts of verdicts."""
    return read_texts(results / "claims_summary.csv")


def test_sentences_have_the_numbers_of_tables_and_the_falls_of_reactions_that_do_not_wait(results: Path) -> None:
    text = made(results)
    assert "MOB-Net-pushed shows 75 % of the torque of such hits; MOB-Net, trained with few pushes, 40 %" in text
    assert "finds 50 % of hits on a swinging leg (2.5 counted), a friction formula 50 % (2.5)" in text
    assert "1 of 20 end in a fall if the robot steps back after an alarm, 20 of 20 if not" in text


def test_the_templates_guard_the_claims_of_which_they_tell() -> None:
    arms = {"model-right-arm", "model-left-arm"}
    assert {"mob-net-cut", "model-walk", "model-swing", "rte-walk", "rte-swing", *arms} <= SAID.keys()
    arms_and_waist = {"model-waist", "model-right-arm", "model-left-arm", "fric-load-hand", "zero-load-10"}
    assert {"mob-net-cut", "model-walk", "model-swing", "gray-walk-net", *arms_and_waist} <= SAID_FOUND.keys()


@pytest.mark.parametrize("claim", SAID)
def test_a_claim_that_is_gone_or_whose_verdict_turned_is_told(results: Path, claim: str) -> None:
    rows = [claim_of(name, "sign at least" if name == claim else None) for name in CLAIMS]
    write_csv(results / "claims.csv", ("claim", "value", "published", "verdict"), rows)
    with pytest.raises(DataError, match=f"claim {claim}: .*README.md.j2 says .*, and it is 'sign at least'"):
        readme(results, ROOT / TEMPLATE)
    rows = [row for row in rows if row[0] != claim]
    write_csv(results / "claims.csv", ("claim", "value", "published", "verdict"), rows)
    with pytest.raises(DataError, match=f"claim {claim} is missing"):
        readme(results, ROOT / TEMPLATE)


def test_a_claim_of_a_field_that_is_gone_is_told(results: Path) -> None:
    template = results / "README.md.j2"
    template.write_text("{{ '%.1f' % c['model-run'] }} times MOB-Net's error")
    with pytest.raises(DataError, match="has no attribute 'model-run', of which"):
        readme(results, template)


@pytest.mark.parametrize(("claim", "value", "sentence"), [
    ("rte-swing", 1.1, "random torque does not help under a hit"),
])  # fmt: skip
def test_a_sentence_that_numbers_do_not_bear_is_told(results: Path, claim: str, value: float, sentence: str) -> None:
    rows = [(name, value, None, SAID[name]) if name == claim else claim_of(name) for name in CLAIMS]
    write_csv(results / "claims.csv", ("claim", "value", "published", "verdict"), rows)
    with pytest.raises(DataError, match=f"README.md.j2 says that {sentence}, and it is otherwise"):
        readme(results, ROOT / TEMPLATE)


def test_a_number_of_a_table_that_is_gone_is_told(results: Path) -> None:
    write_csv(results / "detectors.csv", ("row", "quantity", "value"), [("MOB", "found", 1.0)])
    with pytest.raises(
        DataError, match="MOB-Net-pushed-ratio, found at rate: this row is missing, of which the README tells"
    ):
        readme(results, ROOT / TEMPLATE)


def test_words_and_numbers_of_the_readme_are_few() -> None:
    """All before the section on citing, tables and commands too: a reader takes them in at one sitting."""
    text = README.read_text().split("\n## Cite\n")[0]
    assert len(text.split()) <= 700
    shown = re.sub(r"\]\([^)]*\)", "]", text)
    assert len(re.findall(r"(?<![\w.-])\d[\d.]*", shown)) <= 40


def test_what_a_stranger_sees_first_is_the_finding_the_original_the_commands_and_a_picture_with_an_answer() -> None:
    """In this order and in few lines, so that all of it is on the first screen; the table comes next."""
    text = README.read_text()
    found = ("\n**", "](https://doi.org/", "    ./reproduce demo", "    ./reproduce all", "    ./reproduce test",
             "](docs/results/push.webp)", "\n| error on a walking leg")  # fmt: skip
    places = [text.index(words) for words in found]
    assert places == sorted(places)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert 4 <= len(rows) - 2 <= 5
    assert all(row.count("|") == 4 for row in rows)
    assert rows[2].startswith("| estimate nothing ")  # beside every error


def test_every_word_that_a_stranger_does_not_know_is_explained_before_or_in_the_glossary() -> None:
    text = " ".join(README.read_text().split())
    for word, told in (
        ("MOB-Net-pushed, as torque", "MOB-Net-pushed, trained with a push in nearly every swing"),
        ("best friction formula has", "Our best formula, chosen"),
        ("the residual,", "What it cannot explain"),
    ):
        assert told in text
        assert text.index(told) < text.index(word) + len(told)
    glossary = (ROOT / "docs/glossary.md").read_text()
    for word in ("ratio detector", "reaction", "random torque", "knee hit", "FTS-e2e", "friction formula", "statement"):
        assert re.search(rf"^\| [^|]*{word}", glossary, re.MULTILINE), word


@pytest.fixture
def findings(results: Path) -> Path:
    """Published results with what the page of findings takes beside the README's numbers, which bears its sentences."""
    rows = [claim_of(name, SAID_FOUND.get(name)) for name in (*SAID_FOUND, *SAID)]
    write_csv(results / "claims.csv", ("claim", "value", "published", "verdict"), rows)
    peaks: list[list[str | float]] = []
    for k, name in enumerate((MEMORY, FILMED, MOB_NET)):
        place = {**HIT, "method": name}
        peaks.append([*place.values(), 0.9 - 0.2 * k])
        peaks.append([*{**place, "metric": "rise_delay"}.values(), 10.0 + k])
    write_csv(results / "peaks.csv", (*HIT, "method", "value"), peaks)
    hits = [(*HIT_ERROR.values(), name, 7.0 if name == FILMED else 11.0) for name in ("zero", *UNDER_HITS)]
    write_csv(results / "table_11.csv", (*HIT_ERROR, "method", "value"), hits)
    changed = [(level, *CHANGED_WALK.values(), 3.0 + k) for k, level in enumerate(CHANGED.values())]
    write_csv(results / "changed.csv", ("level", *CHANGED_WALK, "value"), changed)
    parts: list[tuple[str, str, float]] = []
    for limb, row in LIMBS.items():
        best = MEMORY if limb in ("arm", "waist") else MOB_NET
        parts += [(row, name, 1.25 if name == best else 1.5) for name in COMPARED]
    write_csv(results / "limbs.csv", ("row", "quantity", "value"), parts)
    write_detectors(results, share=0.55)
    return results


def write_detectors(results: Path, share: float) -> None:
    """Write what detectors find at a rate of false alarms: the first of them a share, the second half of the hits.

    The interval of the first begins a tenth below its share.
    """
    detected: list[tuple[str, str, float, float]] = []
    for name, value, alarms in zip(RATED, (share, 0.5), (3.0, 4.0), strict=True):
        detected += [(name, "found at rate", value, value - 0.1), (name, "alarms at rate", alarms, 1.0)]
    write_csv(results / "detectors.csv", ("row", "quantity", "value", "low"), detected)


def page_of(results: Path) -> str:
    """Return the page of findings on one line."""
    return " ".join(found(results, ROOT / FOUND_TEMPLATE).split())


def test_the_page_of_findings_has_the_numbers_of_tables(findings: Path) -> None:
    text = page_of(findings)
    assert "it shows 50 % of the peak, at least 12 ms late" in text
    assert "MOB-Net-pushed, trained with a push in nearly every swing, shows 70 %" in text
    assert "MOB-Net's error rises from 3.0 to 4.0 N m, on another robot to 5.0" in text
    assert "they find 55 and 50 % of the hits and cannot be told apart | 3.0 and 4.0 false alarms an hour were" in text
    assert "asked for; the network's share may be as low as 45 % |" in text


@pytest.mark.parametrize("claim", SAID_FOUND)
def test_a_verdict_that_the_page_of_findings_does_not_say_is_told(findings: Path, claim: str) -> None:
    text = (findings / "claims.csv").read_text()
    turned = re.sub(rf"^({claim},.*),[^,]*$", r"\1,sign at least", text, flags=re.MULTILINE)
    assert turned != text
    (findings / "claims.csv").write_text(turned)
    with pytest.raises(DataError, match=f"claim {claim}: .*found.md.j2 says .*, and it is 'sign at least'"):
        page_of(findings)


@pytest.mark.parametrize(("share", "sentence"), [
    (0.4, "the ratio finds more hits"),
    (0.7, "the ratio and the best formula cannot be told apart"),
])  # fmt: skip
def test_a_finding_that_numbers_do_not_bear_is_told(findings: Path, share: float, sentence: str) -> None:
    write_detectors(findings, share)
    with pytest.raises(DataError, match=rf"found\.md\.j2 says that {sentence}, and it is otherwise"):
        page_of(findings)


def test_robots_that_react_and_fall_at_the_knee_are_told(findings: Path) -> None:
    text = (findings / "safety.csv").read_text()
    fallen = text.replace("knee,MOB-Net-pushed-ratio,0,falls,0,", "knee,MOB-Net-pushed-ratio,0,falls,1,")
    assert fallen != text
    (findings / "safety.csv").write_text(fallen)
    with pytest.raises(DataError, match=r"found\.md\.j2 says that robots that react fall less at the knee"):
        page_of(findings)


def test_tables_of_a_run_are_checked_before_they_are_published(findings: Path) -> None:
    write_detectors(findings, share=0.53)
    check_told(findings)
    write_detectors(findings, share=0.4)
    with pytest.raises(DataError, match="it is otherwise"):
        check_told(findings)


def test_the_page_of_findings_is_one_page_with_four_pictures() -> None:
    text = (ROOT / FOUND).read_text()
    assert len(text.split()) <= 900
    assert len(re.findall(r"^!\[", text, re.MULTILINE)) == 4
