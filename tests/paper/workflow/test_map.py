"""docs/map.md is what its command makes; table N of the paper = product = configuration; nothing is an orphan."""

import re
from functools import reduce
from pathlib import Path

import pytest
from paper_settings import settings_at

from experiments.plan.heads import CAPTIONS
from experiments.plan.plan import make_plan
from experiments.site.paper_map import MAP, SOURCE, files_of, paper_map, read_known
from mobnet.core.code import start_of
from mobnet.core.errors import ConfigError

ROOT = Path(__file__).parents[3]
TABLES = [f"Table {n}" for n in (*range(1, 12), 13)]
FIGURES = [f"Figure {n}" for n in (*range(5, 11), *range(12, 21))]
SECTIONS = ["Section 6.1", "Section 6.2", "Section 6.3", "Section 7"]
NUMBERED = re.compile(r"(?:table|figure)_\d\d")
MAIN = settings_at()


KNOWN = read_known(ROOT / SOURCE)


@pytest.fixture(scope="module")
def plan():
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        yield make_plan(MAIN, with_pdf=True, with_mp4=True)  # as the map has it, whatever this machine has


@pytest.fixture(scope="module")
def outputs(plan):
    return {name: product.name for product in plan.products for name in product.outputs}


def test_the_map_is_current(plan):
    remedy = "python -m experiments.site map writes it"
    assert (ROOT / MAP).read_text() == paper_map(plan, KNOWN), remedy


def test_everything_the_paper_numbers_is_on_the_map_once():
    rows = re.findall(r"^\| ([^|]*) \|", (ROOT / MAP).read_text().split("\n## ")[1], re.MULTILINE)
    named = ", ".join(rows).split(", ")
    assert [name for name in (*TABLES, *FIGURES, *SECTIONS) if name not in named] == []
    assert len(set(rows)) == len(rows)


def test_tests_and_inputs_of_the_map_exist():
    """That the others exist, which have the names of products, is known when the map is made."""
    for row in KNOWN.inputs.values():
        assert found(row.key)
        assert (ROOT / row.file).is_file()
    assert [test for test in KNOWN.tests if not (ROOT / test).is_file()] == []


def with_known(section, **values):
    return KNOWN.model_copy(update={section: {**getattr(KNOWN, section), **values}})


def without_known(section, name):
    rows = {key: value for key, value in getattr(KNOWN, section).items() if key != name}
    return KNOWN.model_copy(update={section: rows})


@pytest.mark.parametrize(
    ("known", "problem"),
    [
        (with_known("paper", tabel_09="Section 5"), "paper: 'tabel_09' is not accepted; .*table_09"),
        (with_known("tests", **{"tests/a.py": ("nothing",)}), "tests: 'nothing' is not accepted"),
        (without_known("shows", "manifest"), "shows: 'manifest' is missing; accepted: a text here, or a caption"),
        (without_known("tests", "tests/paper/evaluation/tables/test_falls.py"), "tests: 'random_torque' is missing"),
    ],
)
def test_what_the_map_lacks_or_no_product_has_is_refused(plan, known, problem, monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(ConfigError, match=problem):
        paper_map(plan, known)


def test_files_that_differ_in_their_endings_stand_together():
    assert files_of(["tables/a.csv", "tables/a.md", "results/b"]) == "`tables/a.csv`, .md; `results/b`"
    assert files_of([f"{name}.png" for name in "abcde"]) == "`a.png`; `b.png`; `c.png`; 2 more"


@pytest.mark.parametrize("system", KNOWN.systems, ids=[system.paper for system in KNOWN.systems])
def test_a_system_exists(system):
    names = re.findall(r"`([^`]+)`", f"{system.here} {system.tests}")
    assert names
    assert [name for name in names if not found(name)] == []


def found(name):
    """Return whether a name is a file, a module or a key of the configuration."""
    if "/" in name:
        return (ROOT / name).exists()
    if name.startswith(("mobnet.", "experiments.")):
        return start_of(name).is_file()

    def below(section, key):
        return section[key] if isinstance(section, dict) else getattr(section, key)

    return reduce(below, name.split("."), MAIN) is not None


def numbered(names):
    return {found for name in names for found in NUMBERED.findall(name)}


def test_no_numbered_table_or_figure_is_an_orphan(outputs):
    evaluation = MAIN.evaluation
    configured = numbered((*type(evaluation).model_fields, *evaluation.tables))
    assert numbered(outputs) == configured
    text = (ROOT / "paper/main.tex").read_text()
    assert [name for name in configured if name not in text] == []


def test_every_table_and_figure_of_ours_has_a_caption_that_begins_with_a_sentence(outputs):
    """Ours say what is drawn before how to read it; that no caption asks is a test of captions."""
    places = {".md": "tables", ".png": "figures"}
    ours = {
        f"{folder}/{Path(file).stem}"
        for file in outputs
        if (folder := places.get(Path(file).suffix)) and not NUMBERED.match(Path(file).stem)
    }
    assert {"tables/compute", "tables/claims", "figures/bode"} <= ours
    for name in sorted(ours):
        _, empty, *lines = (ROOT / CAPTIONS / f"{name}.rst").read_text(encoding="utf-8").splitlines()
        assert not empty, name
        assert re.match(r"[A-Z].+?\.(?: |$)", " ".join(lines)), name


def test_the_guide_says_what_each_scale_takes():
    """Time, core-hours, memory and disk."""
    lines = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in (ROOT / "docs/guide.md").read_text().splitlines()
    ]
    rows = {cells[0].strip("`"): cells[2:] for cells in lines if cells[0].strip("`") in MAIN.scales}
    assert list(rows) == list(MAIN.scales)
    assert all(len(numbers) == 4 and all(re.match(r"\d", number) for number in numbers) for numbers in rows.values())
