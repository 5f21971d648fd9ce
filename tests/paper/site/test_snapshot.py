"""The snapshot holds tables, pictures and their origin, and every difference from it is told in one line."""

from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from paper_settings import settings_at
from PIL import Image

from experiments.evaluation.report.manifest import write_lists
from experiments.running.accounts import Account
from experiments.running.words import MANIFEST
from experiments.site.blocks import with_block
from experiments.site.snapshot import (
    RESULTS,
    check_paper,
    check_run,
    compare_snapshot,
    is_words,
    main,
    read_keyed,
    write_snapshot,
)
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

REPO = Path(__file__).parents[3]
SETTINGS = settings_at()
TABLES, FIGURES, COMPUTE, STORED = (Path(name) for name in ("tables", "figures", "compute.md", "docs/results"))
SHADES = np.random.default_rng(1).integers(0, 256, (64, 64), dtype=np.uint8)
# More shades than a palette has, and a clear margin, as around a figure.
PICTURE = np.dstack([SHADES] * 3 + [np.full_like(SHADES, 255)])
PICTURE[:8, :, 3] = 0
TABLE = (
    "scenario,level,method,joint,metric,value,published\nwalk,ideal,MOB,LL1,rmse,1.5,2\nwalk,ideal,MOB,LL2,rmse,3,4\n"
)


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A working folder with a fresh table and a snapshot of it."""
    monkeypatch.chdir(tmp_path)
    made = {TABLES / "table_05.csv": TABLE, TABLES / "table_05.md": "x", TABLES / "table_05.tex": "t", COMPUTE: "c"}
    made |= {FIGURES / "figure_05.svg": "s", FIGURES / "push.webp": "w", FIGURES / "figure_05.csv": "x,y\n1,2\n3,4\n"}
    for path, text in made.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    Image.fromarray(PICTURE).save(FIGURES / "figure_05.png")
    write_snapshot(SETTINGS, TABLES, FIGURES, [COMPUTE], STORED)


def rewrite(old: str, new: str) -> list[str]:
    """Return the differences after an edit of the fresh table."""
    (TABLES / "table_05.csv").write_text(TABLE.replace(old, new))
    return compare_snapshot(STORED, TABLES, FIGURES)


@pytest.mark.usefixtures("stored")
def test_snapshot_holds_tables_and_pictures_with_their_origin() -> None:
    names = sorted(path.name for path in STORED.iterdir())
    assert names == [
        "compute.md", "figure_05.png", "figures", "provenance.json", "push.webp", "table_05.csv", "table_05.md",
        "table_05.tex",
    ]  # fmt: skip
    assert set(read_json(STORED / "provenance.json")) == {"scale", "commit", "lock"}


@pytest.mark.usefixtures("stored")
def test_a_stored_picture_looks_the_same_and_is_smaller() -> None:
    with Image.open(STORED / "figure_05.png") as image:
        shown = np.asarray(image.convert("RGB"), dtype=int)
    seen = np.where(PICTURE[..., 3:] == 0, 255, PICTURE[..., :3]).astype(int)
    assert np.abs(shown - seen).mean() < 2.0
    assert (STORED / "figure_05.png").stat().st_size < (FIGURES / "figure_05.png").stat().st_size


@pytest.mark.usefixtures("stored")
def test_what_is_made_no_longer_is_removed_with_the_next_snapshot() -> None:
    for ending in ("png", "svg", "csv"):
        (FIGURES / f"figure_05.{ending}").rename(FIGURES / f"figure_06.{ending}")
    for name in ("rates.json", "walking.png"):  # made by other means
        (STORED / name).write_text("{}")
    (STORED / "table_04.csv").write_text("a\n1\n")
    for ending in ("md", "tex"):
        (STORED / f"table_04.{ending}").write_text("a")
    write_snapshot(SETTINGS, TABLES, FIGURES, [COMPUTE], STORED)
    names = sorted(path.name for path in STORED.rglob("*") if path.is_file())
    assert names == [
        "compute.md", "figure_06.csv.gz", "figure_06.png", "provenance.json", "push.webp", "rates.json", "table_05.csv",
        "table_05.md", "table_05.tex", "walking.png",
    ]  # fmt: skip


@pytest.mark.usefixtures("stored")
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("", "", []),
        ("1.5", "1.6", ["table_05.csv: walk ideal MOB LL1 rmse: value 1.5 -> 1.6"]),
        ("walk,ideal,MOB,LL2,rmse,3,4\n", "", ["table_05.csv: walk ideal MOB LL2 rmse: row is gone"]),
        ("MOB,LL1", "MOB,LL3", ["walk ideal MOB LL1 rmse: row is gone", "walk ideal MOB LL3 rmse: row is new"]),
    ],
)
def test_a_changed_cell_and_a_changed_row_are_told_once(old: str, new: str, told: list[str]) -> None:
    found = rewrite(old, new)
    assert len(found) == len(told)
    assert all(line.endswith(text) for line, text in zip(found, told, strict=True))


@pytest.mark.usefixtures("stored")
def test_a_missing_file_is_named_and_nothing_is_copied() -> None:
    with pytest.raises(DataError, match=r"none\.md: file is missing; \./reproduce all makes it"):
        write_snapshot(SETTINGS, TABLES, FIGURES, [Path("none.md")], Path("out"))
    assert not Path("out").exists()
    (TABLES / "table_05.csv").unlink()
    told = ["tables/table_05.csv: file is missing; ./reproduce all makes it"]
    assert compare_snapshot(STORED, TABLES, FIGURES) == told
    with pytest.raises(DataError, match="tables: holds no CSV"):
        write_snapshot(SETTINGS, TABLES, FIGURES, [COMPUTE], Path("out"))
    with pytest.raises(DataError, match="tables: holds no CSV"):
        compare_snapshot(TABLES, STORED, FIGURES)


@pytest.mark.usefixtures("stored")
def test_verdicts_that_turned_are_counted(caplog: pytest.LogCaptureFixture) -> None:
    head = "claim,quantity,value,verdict\n"
    (STORED / "claims.csv").write_text(f"{head}a,ratio,1.0,reproduced\nb,ratio,1.0,open\nc,ratio,2.0,open\n")
    (TABLES / "claims.csv").write_text(f"{head}a,ratio,1.1,reproduced\nb,ratio,1.2,reproduced\nc,ratio,2.0,open\n")
    with caplog.at_level("INFO"):
        assert main(["compare"]) == 1
    assert caplog.messages[-2:] == ["claims.csv: verdicts that differ: 1", "docs/results: 3 differences"]


@pytest.mark.usefixtures("stored")
def test_a_changed_figure_is_told_by_its_rows() -> None:
    drawn = FIGURES / "figure_05.csv"
    drawn.write_text("x,y\n1,2\n3,5\n6,7\n")
    assert compare_snapshot(STORED, TABLES, FIGURES) == ["figures/figure_05.csv: 2 of 4 rows differ"]
    drawn.unlink()
    assert compare_snapshot(STORED, TABLES, FIGURES) == [
        "figures/figure_05.csv: file is missing; ./reproduce all makes it"
    ]


def test_a_paper_whose_text_does_not_fit_its_results_is_not_published(tmp_path: Path) -> None:
    note = tmp_path / "build.json"
    write_json(note, {"pdf": "main.pdf", "unfit": []})
    check_paper(tmp_path / "main.pdf")
    write_json(note, {"pdf": "main.pdf", "unfit": ["claim 'a' is 'open', and the text needs 'reproduced'"]})
    with pytest.raises(DataError, match=r"claim 'a' is 'open'.*; mend the words of .*main\.tex, and call"):
        check_paper(tmp_path / "main.pdf")


def note_of(name: str, made_by: str, start_s: float) -> None:
    """Write the note of a recording, and the account of the job that made it in 10 s."""
    write_json(RESULTS / "recordings" / f"{name}.json", {"provenance": {"commit": made_by}})
    account = Account(f"collect/{name}", start_s, start_s + 10.0, 10.0, 9.0, 100.0, succeeded=True, commit=made_by)
    write_json(RESULTS / "logs" / "collect" / f"{name}.json", asdict(account))


@pytest.fixture
def run_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """A function that checks a run of two recordings, made by commit `abc`, at another one: run_of(head, changed)."""
    monkeypatch.chdir(tmp_path)
    for index, name in enumerate("xy"):
        note_of(name, "abc", 10.0 * index)
    write_lists(RESULTS.rglob("recordings/*.json"), [], MANIFEST)

    def check(head: str, changed: list[str] | None = None) -> str:
        monkeypatch.setattr("experiments.site.snapshot.commit", lambda: head)
        monkeypatch.setattr("experiments.site.snapshot.changed_between", lambda *_: changed)
        return check_run(RESULTS, MANIFEST)

    return check


def test_a_snapshot_is_of_one_commit(run_of: Callable[..., str]) -> None:
    run_of("abc")
    with pytest.raises(DataError, match=r"commit abc-changed: is not accepted; accepted: a checkout without changed"):
        run_of("abc-changed")
    with pytest.raises(DataError) as told:
        run_of("def")
    line = "logs/collect/x.json: commit abc is not accepted; accepted: def (3 further files)"
    assert str(told.value) == f"{RESULTS}/{line}"
    note_of("y", "abc", 5000.0)  # the run was stopped for more than an hour
    run_of("abc")
    note_of("y", "def", 5000.0)
    with pytest.raises(DataError, match=r"logs/collect/y\.json: commit def is not accepted; accepted: abc \(1 further"):
        run_of("abc")
    note_of("y", "abc", 5000.0)
    (RESULTS / "recordings" / "x.json").write_text("{}")
    with pytest.raises(DataError, match=r"recordings/x\.json: hash .*, the manifest says"):
        run_of("abc")


@pytest.mark.usefixtures("stored")
def test_exit_status_tells_whether_anything_differs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("logging.basicConfig", lambda **_: None)
    assert main(["compare"]) == 0
    assert rewrite("1.5", "1.6")
    assert main(["compare"]) == 1
    assert main(["compare", "--config", "scale=smoke"]) == 1  # published is the scale default
    assert main(["verify"]) == 1  # there is no manifest


def test_the_headline_replaces_what_stood_between_the_marks_and_nothing_else() -> None:
    page = "a\n<!-- table -->\nold\n<!-- /table -->\nb\n"
    once = with_block(page, "table", "| new |\n", Path("a.md"))
    assert once == page.replace("old", "| new |")
    assert with_block(once, "table", "| new |\n", Path("a.md")) == once
    with pytest.raises(DataError, match="marks"):
        with_block("no marks", "table", "| new |", Path("a.md"))


@pytest.mark.parametrize("stored", sorted((REPO / "docs/results").glob("*.csv")), ids=lambda path: path.stem)
def test_every_row_of_the_stored_tables_has_a_name_of_its_own(stored: Path) -> None:
    """Otherwise `compare` would look only at the last row of a name."""
    assert len(read_keyed(stored)) == len(stored.read_text().splitlines()) - 1


def test_words_may_change_after_the_run_and_numbers_may_not(run_of: Callable[..., str]) -> None:
    words = ["README.md", "paper/main.tex", "workflow/report/tables/table_05.rst", "configs/claims.yaml"]
    assert run_of("def", words) == "abc"
    with pytest.raises(DataError, match=r"commit abc is not accepted; accepted: def, from which configs/scales\.yaml"):
        run_of("def", [*words, "configs/scales.yaml"])
    for name in ("docs/registered.json", "docs/trials/why.csv", "src/mobnet/core/code.py", "workflow/rules/learn.smk"):
        assert not is_words(name)
