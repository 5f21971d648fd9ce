"""Documents are in the index, their links lead somewhere, and what they say twice agrees."""

import contextlib
import importlib.util
import json
import pkgutil
import re
import shlex
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from links import broken
from snakemake.cli import get_argument_parser

from experiments.commands.words import PARSERS, parse
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings
from experiments.site.readme import FOUND, FOUND_TEMPLATE, TEMPLATE, found, readme, scales
from mobnet.commands import COMMANDS as LAB
from mobnet.commands import demo_parser
from mobnet.core.errors import MobnetError

ROOT = Path(__file__).parents[3]
INDEX = ROOT / "docs" / "README.md"
PAGES = sorted(path for part in ("*.md", "paper/*.md", "docs/*.md", "docs/notes/*.md") for path in ROOT.glob(part))
NUMBERED = ROOT / "docs" / "notes" / "README.md"  # where the notes with numbers are
NOTES = sorted(path for path in NUMBERED.parent.glob("*.md") if path != NUMBERED)
OLD_NUMBER = re.compile(r"^\| (\d{4}) \| \[", re.MULTILINE)
CITED = re.compile(r"\bnotes?[\s_#*-]+\d{4}\b(?:(?:,| and| to)[\s#*]+\d{4}\b)*", re.IGNORECASE)
TEXTS = ("*.md", "*.lock", "paper/*.tex", "docs/**/*.md", "configs/**/*.yaml", "workflow/**/*.*", "src/**/*.[pc]*")
CHANGELOG_WORDS = 600  # of a version
BINARY = (".pyc", ".png", ".svg")
CITING = sorted(path for part in (*TEXTS, "tests/**/*.py") for path in ROOT.glob(part) if path.suffix not in BINARY)
PROGRAMS = r"\./reproduce|mobnet|python -m|snakemake"
COMMAND = re.compile(rf"`((?:{PROGRAMS}) [^`\n]+(?:\n[^`\n]+)?)`")  # a line of a document may end within it
CODE_BLOCK = re.compile(rf"^(?:#)? {{4,}}((?:{PROGRAMS}) [^=*\n]+)$", re.MULTILINE)  # of C, `mobnet` is a type
COMMENT = re.compile(r"\n[ \t]*(?:#|//) ?(?=\S)")  # begins a line of a comment that goes on
PLACEHOLDER = re.compile(r"[A-Z]{3,}|[{}\[\]]|\.\.\.")  # in a word that stands for others
PLACES = (*TEXTS, "Snakefile", "Dockerfile", "apptainer.def", "pyproject.toml", "benchmarks/*.py", "src/**/*.[ch]")
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
BESIDE = re.compile(r"^```.*?^```$|^(?: {4}|\|)[^\n]*$", re.MULTILINE | re.DOTALL)  # what is no prose: code and tables
TOLD_BOUNDS = ("configs/claims.yaml", "paper/main.tex", "workflow/report/start/index.rst")
BOUNDS = (
    "Bounds follow one rule for each kind of claim. Rules and some bounds were changed after results had been seen, of "
    "0.5.0 and of 0.6.0, each time before walks that no earlier run had walked; CHANGELOG lists every verdict that "
    "moved."
)
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def links(page):
    return [(page.parent / name).resolve() for name in LINK.findall(page.read_text())]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_leads_to_a_file_and_to_a_heading_of_it(page):
    assert list(broken([page])) == []


def test_a_link_to_no_file_or_no_heading_is_found(tmp_path):
    (tmp_path / "b.md").write_text("# One: two, three\n\n## Same\n\n## Same\n")
    links = (
        "b.md",
        "b.md#one-two-three",
        "b.md#same-1",
        "https://x.org",
        "b.md#four",
        "c.md",
        "#nowhere",
    )
    (tmp_path / "a.md").write_text("\n".join(f"[x]({link})" for link in links) + "\n\n    [x](code.md)\n")
    assert [line.split(": ")[1] for line in broken([tmp_path / "a.md"])] == ["b.md#four", "c.md", "#nowhere"]


@pytest.fixture(scope="module")
def made():
    """All files that the workflow makes at the scale of the documents."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        plan = make_plan(load_settings(overrides={"scale": "default"}), with_pdf=True, with_mp4=True)
    products = (*plan.products, *plan.trials, *plan.films, *plan.docs)
    files: set[str] = set()
    for product in products:
        files.update((*product.inputs, *product.outputs))
    return files | {str(Path(name).parent) for name in files}


def commands_in(path):
    """Return the commands that a document, or the comments and texts of a file, tell to type."""
    text = COMMENT.sub(" ", path.read_text(encoding="utf-8"))
    found = [*COMMAND.findall(text), *CODE_BLOCK.findall(path.read_text(encoding="utf-8"))]
    return [re.split(r" && | \| ", " ".join(line.split()))[0] for line in found]


def commanding():
    """Return the files that tell to type a command; made pages and what older versions said are of their own time."""
    files = {path for part in PLACES for path in ROOT.glob(part) if path.suffix not in BINARY}
    own = [path for path in sorted(files) if "docs/results" not in str(path) and path.name != "CHANGELOG.md"]
    return [path for path in own if commands_in(path)]


def refused(line, made):
    """Return what is wrong with a command: a command, an option or a target that there is not; None if all is right."""
    line = re.sub(r"--config \w+=[A-Z]{3,}", "", line)  # an option goes with the word that stands for its value
    program, *words = shlex.split(line, comments=True)
    words = [word for word in words if not PLACEHOLDER.search(word)]
    if program == "python":
        return refused_module(words[1:])
    if program == "mobnet":
        return refused_lab(words)
    if program == "snakemake":
        get_argument_parser().parse_args(words)
    elif (command := parse([word for word in words if word != "--help"] or ["all"]).command) in PARSERS:
        known = PARSERS[command]().format_help()
        if unknown := [word for word in words if word.startswith("--") and f"{word} " not in f"{known} --help "]:
            return unknown
    targets = [word for word in words if re.match(r"(tables|figures|results)/(?!smoke)", word)]
    return [target for target in targets if target not in made]


def refused_module(words):
    """Return the module of `python -m` if it cannot be run, or its options that its text does not name."""
    if not words:
        return []
    name, *others = words
    parts = name.split(".")
    if parts[0] not in ("mobnet", "experiments", "benchmarks"):
        return [] if importlib.util.find_spec(name) else [name]
    place = (ROOT if parts[0] == "benchmarks" else ROOT / "src").joinpath(*parts)
    package, module = place / "__main__.py", place.with_suffix(".py")
    if not package.is_file() and not (module.is_file() and '__name__ == "__main__"' in module.read_text()):
        return [name]
    text = (package if package.is_file() else module).read_text()
    return [word for word in others if word.startswith("--") and word != "--help" and f'"{word}"' not in text]


def refused_lab(words):
    """Return the command of `mobnet` that there is not, or its options."""
    if not words or words[0].startswith("--"):
        return []
    name, *others = words
    if name not in (*LAB, "demo"):
        return [name]
    known = (LAB[name].parser() if name in LAB else demo_parser()).format_help()
    return [word for word in others if word.startswith("--") and f"{word} " not in known]


@pytest.mark.parametrize("path", commanding(), ids=lambda path: str(path.relative_to(ROOT)))
def test_every_command_that_is_told_is_accepted_with_its_options_and_its_targets_are_made(path, made):
    """What is made by a part that CONTRIBUTING tells to add is made in tests/contract."""
    for line in commands_in(path):
        wanted = {"tables/roughness.md", "figures/joint_errors.pdf"} if path.name == "CONTRIBUTING.md" else set()
        assert not refused(line, made | wanted), line


@pytest.mark.parametrize("line", [
    "python -m mobnet.settings", "python -m mobnet.no_module", "python -m experiments.look --sezond 3",
    "mobnet obseve x", "mobnet observe x --gian 3", "./reproduce observe x --gian 3", "./reproduce tables/table_99.tex",
    "snakemake tables/table_99.tex",
])  # fmt: skip
def test_a_command_that_there_is_not_is_found(line, made):
    with contextlib.suppress(MobnetError, SystemExit):
        assert refused(line, made)


def test_readme_findings_and_guide_have_the_numbers_of_the_published_results():
    """`python -m experiments.site readme` writes them."""
    results = ROOT / "docs" / "results"
    assert (ROOT / FOUND).read_text() == found(results, ROOT / FOUND_TEMPLATE)
    assert (ROOT / "README.md").read_text() == readme(results, ROOT / TEMPLATE)
    assert f"<!-- scales -->\n{scales(results).strip()}\n<!-- /scales -->" in (ROOT / "docs/guide.md").read_text()


def test_every_document_and_every_folder_of_documents_is_in_the_index_once():
    folders = [path for path in (ROOT / "docs").iterdir() if path.is_dir() and path.name != "notes"]
    wanted = [*(set(PAGES) - {INDEX}), *folders]
    found = links(INDEX)
    assert [path for path in wanted if found.count(path) != 1] == []


def test_the_index_says_one_sentence_of_each_note_once():
    rows = re.findall(r"^\| \[[^]]+\]\(notes/(\w+\.md)\) \| [A-Z].*\. \|$", INDEX.read_text(), re.MULTILINE)
    assert sorted(rows) == sorted([*(path.name for path in NOTES), NUMBERED.name])


def test_notes_are_few_and_named_by_their_subjects():
    assert 1 < len(NOTES) <= 18
    assert [path.name for path in NOTES if not re.fullmatch(r"[a-z]+(_[a-z]+)*\.md", path.name)] == []
    assert [path for path in NOTES if not re.match(r"# [A-Z]", path.read_text())] == []


def test_the_table_of_old_numbers_has_each_that_the_changelog_cites():
    cited = " ".join(CITED.findall((ROOT / "CHANGELOG.md").read_text()))
    assert OLD_NUMBER.findall(NUMBERED.read_text()) == sorted(set(re.findall(r"\d{4}", cited)))


def test_links_lead_to_headings_and_not_to_anchors_of_old_numbers():
    assert [path for path in PAGES if re.search(r"<a id=|#note-\d", path.read_text())] == []


def test_every_number_and_every_file_of_a_note_that_is_named_anywhere_leads_somewhere():
    known = OLD_NUMBER.findall(NUMBERED.read_text())
    named, lost = 0, list[str]()
    for path in CITING:
        text = path.read_text(encoding="utf-8")
        numbers = [number for found in CITED.findall(text) for number in re.findall(r"\d{4}", found)]
        named += len(numbers)
        lost += [f"{path}: note {number}" for number in numbers if number not in known]
        files = set(re.findall(r"docs/notes/(\d{4}|[\w-]+\.md)", text))
        lost += [f"{path}: {name}" for name in files if not (ROOT / "docs" / "notes" / name).is_file()]
    assert lost == []
    assert named > 10


def test_the_newest_version_is_that_of_the_published_results_and_of_the_citation():
    version, date, text = re.findall(
        r"^## ([\d.]+), ([\d-]+)\n(.*?)(?=^## |\Z)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE | re.DOTALL
    )[0]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert PROJECT["project"]["version"] == citation["version"] == version
    assert str(citation["date-released"]) == date
    commit = json.loads((ROOT / "docs" / "results" / "provenance.json").read_text())["commit"]
    assert commit[:7] in text


def test_the_changelog_says_of_each_version_what_fits_on_a_page():
    """Details stand in the notes: nobody reads a thousand lines to learn what moved."""
    counts: dict[str, int] = {}
    for section in re.split(r"^## ", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1:]:
        version, _, text = section.partition("\n")
        counts[version] = len(text.split())
    assert len(counts) >= 7
    assert {version: count for version, count in counts.items() if count > CHANGELOG_WORDS} == {}


def test_readme_citation_and_references_name_the_original_by_one_doi_and_the_version_that_is_reproduced():
    """The entry of the original is the one that the paper cites; keys of BibTeX are no placeholders."""
    readme = (ROOT / "README.md").read_text().split("\n## Cite\n")[1]
    entry = re.search(
        r"@article\{lim2023mobnet,.*?^\}", (ROOT / "paper/refs.bib").read_text(), re.MULTILINE | re.DOTALL
    )
    assert entry
    (original,) = yaml.safe_load((ROOT / "CITATION.cff").read_text())["references"]
    doi, version = original["doi"], "2402.11221v1"
    assert re.findall(r"doi\s*= \{(.*?)\}", entry[0]) == [doi]
    assert re.findall(r"doi\s*= \{(.*?)\}", readme) == [doi]
    assert original["url"] == f"https://doi.org/{doi}"
    assert f"https://doi.org/{doi}" in (ROOT / "README.md").read_text()
    assert doi in (ROOT / "docs" / "deviations.md").read_text()
    for text in (entry[0], readme, original["identifiers"][0]["value"]):
        assert version in text
    keys = re.findall(r"@\w+\{(\w+),", readme)
    assert keys == ["lim2024mobnet", "mobnet2026reproduction"]
    assert f"version = {{{PROJECT['project']['version']}}}" in readme


@pytest.mark.parametrize("name", TOLD_BOUNDS)
def test_when_bounds_were_fixed_is_told_in_one_sentence_everywhere(name):
    text = re.sub(r"^# ", "", (ROOT / name).read_text(), flags=re.MULTILINE)
    words = " ".join(re.sub(r"\[(\w+)\]\([^)]*\)", r"\1", text).split())
    assert words.count(BOUNDS) == 1
    assert re.findall("[^.;]*(?:[Bb]ounds|[Rr]ules of verdicts) were fixed[^.;]*", words) == []


@pytest.mark.slow
def test_the_environment_has_as_many_files_as_the_page_of_clusters_says():
    (told,) = re.findall(r"environment has about ([\d ]+) files", (ROOT / "docs" / "cluster.md").read_text())
    files = sum(path.is_file() for path in Path(sys.prefix).rglob("*"))
    assert files == pytest.approx(int(told.replace(" ", "")), rel=0.15)


def test_the_guide_draws_the_packages_as_the_import_linter_checks_them():
    """Its arrows are the layers of each wing, and its tables name every package once."""
    contracts = PROJECT["tool"]["importlinter"]["contracts"]
    layers = {one["containers"][0]: one["layers"] for one in contracts if one["type"] == "layers"}
    part = (ROOT / "CONTRIBUTING.md").read_text().split("\n## How it fits together\n")[1].split("\n## ")[0]
    for wing in ("mobnet", "experiments"):
        assert re.findall(rf"^ {{4}}{wing}: (.*)$", part, re.MULTILINE) == [" -> ".join(layers[wing])]
        (table,) = re.findall(rf"^\| package of `{wing}` \|.*\n.*\n((?:\| .*\n)+)", part, re.MULTILINE)
        named = re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)))
        modules = [module.name for module in pkgutil.iter_modules([str(ROOT / "src" / wing)])]
        assert sorted(named) == sorted(name for name in modules if name != "__main__")


@pytest.mark.parametrize("name", ["robots.md", "logs.md"])
def test_a_guide_of_the_lab_is_read_in_ten_minutes(name):
    """Words beside code and tables, at 200 a minute."""
    prose = BESIDE.sub("", (ROOT / "docs" / name).read_text())
    assert 500 <= len(prose.split()) <= 2000
