"""The README's blocks come from the published CSVs, and its own words are few."""

import re
from pathlib import Path

import pytest

from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.report.readme import COLUMNS, FINDINGS, blocks
from experiments.settings.load import load_settings
from mobnet.core.columns import CLAIMED, HELD, NEAR, OURS, PAPER, PRINTED, UNEXPLAINED, VERDICTS
from mobnet.core.errors import DataError
from mobnet.core.files import write_json

README = Path(__file__).parents[3] / "README.md"
PLACE = ("scenario", "level", "joint", "metric", "method", "value", "published")
CLAIMS = sorted({name for text in FINDINGS for name in re.findall(r"c\[([^]]*)\]", text)})


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """Published results: the error of a method is its place in the list, and that of MOB is printed."""
    for _, table, place in COLUMNS:
        cells = [place.get(name, "robots") for name in PLACE[:4]]
        methods = ["zero", "MOB", "MOB-fric-dahl", "MOB-Net"]
        rows = [(*cells, method, float(k), 9.0 if method == "MOB" else None) for k, method in enumerate(methods)]
        write_csv(tmp_path / f"{table}.csv", PLACE, [("other", *rows[0][1:]), *rows])
    write_csv(tmp_path / "claims.csv", ("claim", "value", "published"), [(name, 0.5, None) for name in CLAIMS])
    falls = [
        (case, detector, wait_s, "falls", share, 20)
        for case in ("foot", "knee")
        for detector, wait_s, share in (("MOB-Net-ratio", 0.0, 0.05), ("MOB-Net-ratio", 0.4, 0.9), ("none", 0.0, 1.0))
    ]
    write_csv(tmp_path / "safety.csv", ("case", "detector", "wait_s", "measure", "value", "walks"), falls)
    outcomes = [*VERDICTS, "all", UNEXPLAINED, PRINTED, HELD, NEAR]
    counts = [
        (score, name, 10 * k + j, k, 2 * k) for j, score in enumerate((PAPER, OURS)) for k, name in enumerate(outcomes)
    ]
    write_csv(tmp_path / "claims_summary.csv", CLAIMED, counts)
    (tmp_path / "compute.md").write_text(
        "| all jobs | 2 | 6.00 | 8.00 | 75 | 9 |\n| elapsed (cores: 2) |  |  | 4.12 | 73 |  |\n"
    )
    note = {"processor": "made-up", "scale": "default", "core_h": 6.04, "peak_mib": 9.0, "kinds": {}}
    write_json(tmp_path / "rates.json", note)
    return tmp_path


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


def test_errors_stand_beside_those_of_the_paper_and_a_dash_where_no_method_ran(results: Path) -> None:
    lines = blocks(results)["headline"].splitlines()
    assert lines[2] == "| estimate nothing | 0.0 | 0.0 | 0.0 |"
    assert lines[3] == "| momentum observer (MOB) | 1.0 (9.0) | 1.0 (9.0) | 1.0 (9.0) |"
    assert lines[4].endswith("| - | - | - |")
    assert lines[6].endswith("| 2.0 | 2.0 | 2.0 |")


def test_statements_of_the_paper_and_our_own_are_counted_apart(results: Path) -> None:
    text = blocks(results)["claims_summary"]
    assert "| not reproduced | 0 | 0 | 1 |" in text
    assert "| reproduced | 40 | 4 | 41 |" in text
    assert "Of the 10 statements of the paper whose size or sign is refuted, 70 have" in text
    assert "Of 16 claims with a printed number this number lies in our interval in 18" in text


def test_findings_have_the_numbers_of_claims_and_the_falls_of_reactions_that_do_not_wait(results: Path) -> None:
    text = blocks(results)["findings"]
    assert "multiplies MOB-Net's error by 0.50 in random walking (paper nan)" in text
    assert "1 of 20 fall with the reaction and 20 of 20 without it." in text
    assert len(text.splitlines()) == len(FINDINGS)


def test_a_claim_that_is_gone_is_told(results: Path) -> None:
    write_csv(results / "claims.csv", ("claim", "value", "published"), [(name, 0.5, None) for name in CLAIMS[1:]])
    with pytest.raises(DataError, match=f"{CLAIMS[0]}.*README"):
        blocks(results)


def test_the_words_of_the_readme_are_few() -> None:
    """Those that are not made: without blocks, tables and commands."""
    text = re.sub(r"<!-- (\w+) -->.*?<!-- /\1 -->", "", README.read_text(), flags=re.DOTALL)
    prose = [line for line in text.splitlines() if not line.startswith(("|", "    "))]
    assert len(" ".join(prose).split()) <= 800
