"""The documentation as pages: all documents, and pages made of results, configuration and docstrings, by Sphinx.

Documents are Markdown whose relative links work on a code host. They keep their places in the folder that Sphinx reads,
so that the links work on the pages too; only those to folders and to the first page are rewritten.
"""

import logging
import os
import posixpath
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from experiments.evaluation.report.captions import filled
from experiments.evaluation.report.claims_page import claims_page
from experiments.evaluation.report.numbers import texts_in
from experiments.evaluation.report.pages import titled
from experiments.plan.heads import table_in
from experiments.settings.claims import Claim
from experiments.settings.runs import Statistics
from experiments.site.contents import README, menu, menus, sections
from experiments.site.reference import INTERNALS, PUBLIC, reference_pages
from experiments.site.results import ALL_CLAIMS, CLAIMS_PAGE, result_pages
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text
from mobnet.core.heartbeat import last_line, telling
from mobnet.formats.reading import read_yaml

log = logging.getLogger(__name__)

INDEX = Path("docs/README.md")
RESULTS = Path("docs/results")
TRIALS = Path("docs/trials")
SEARCHED = Path("docs/search.yaml")  # page or heading -> words for which the search finds it first
INTERFACE = Path("docs/interface.md")
FIRST = "index.md"  # the README, where a browser looks for the first page
MADE = {  # section of the index -> pages that are made
    "Reference": ("reference/commands.md", "reference/configuration.md"),
    "Project": ("docs/README.md",),
}
LINK = re.compile(r"(?<=\]\()([^)#:\s]+)(?=[)#])")
ACCESSIBLE = {  # what the theme writes -> the same as screen readers and keyboards need it
    'role="heading"': 'role="heading" aria-level="2"',
    '<aside class="sidebar-drawer': '<aside aria-label="all pages" class="sidebar-drawer',
    '<aside class="toc-drawer': '<aside aria-label="this page" class="toc-drawer',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
    "<pre": '<pre tabindex="0"',
    '<div id="search-results"': '<h1>Search</h1>\n<div id="search-results"',
}
FIXED = {"SOURCE_DATE_EPOCH": "0", "PYTHONHASHSEED": "0"}  # equal pages from equal documents


def docs(
    documents: Sequence[Path],
    captions: Sequence[Path],
    modules: Sequence[Path],
    claims: Mapping[str, Claim],
    statistics: Statistics,
    templates: Sequence[Path],
    out: Path,
) -> None:
    """Write the documentation as HTML pages into the folder `out`.

    Args:
        documents: files of the documentation, relative to the project's folder: Markdown, pictures, CSVs, settings.
        captions: of tables and figures, reStructuredText.
        modules: files of all modules, of which those of public packages are shown.
        claims: of the paper, by name.
        statistics: have the confidence of the claims' intervals.
        templates: that of the page of claims, and its parts.
        out: gets `index.html`.

    Raises:
        DataError: one line for each warning of Sphinx, such as a reference that leads nowhere.
    """
    log.info("making the pages from %d files", len(documents) + len(captions) + len(modules))
    with TemporaryDirectory() as made:
        folder = Path(made) / "sources"
        with telling(log, lambda: "writing the pages that Sphinx reads"):
            write_sources(folder, documents, captions, modules, claims)
        built = build(folder, Path(made) / "pages")
        (caption,) = (path for path in captions if path.stem == ALL_CLAIMS and path.parent.name == "tables")
        published = RESULTS / f"{ALL_CLAIMS}.csv"
        title, text = titled(filled(caption, texts_in(RESULTS)))
        page = claims_page(published, statistics.confidence, title, text, templates[0])
        write_text(built / CLAIMS_PAGE, page)
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(built, out)
    log.info("%s: %d pages", out, len(list(out.rglob("*.html"))))


def write_sources(
    folder: Path,
    documents: Sequence[Path],
    captions: Sequence[Path],
    modules: Sequence[Path],
    claims: Mapping[str, Claim],
) -> None:
    """Write what Sphinx reads into a folder: documents, and pages that are made; arguments are those of `docs`."""
    # Documents keep their places, so that the links between them work on the pages, too.
    for path in documents:
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / path)
    shutil.move(folder / "docs" / "conf.py", folder / "conf.py")
    index = read_text(INDEX)
    grouped: list[tuple[str, str]] = []
    listed: set[Path] = set()
    for section in sections(index).values():
        grouped += [(group.path, group.page) for group in section.groups]
        listed.update(map(Path, section.documents))
    pages = [*grouped, *result_pages(RESULTS, captions, claims), *trial_pages(), *reference_pages(modules_of(modules))]
    for path, text in pages:
        write_text(folder / path, text)
    # Modules are internal: their pages are below that of the names for programs of others, not beside the guides.
    write_text(folder / INTERFACE, f"{read_text(INTERFACE)}\n{menu([INTERNALS])}")
    # The index also links folders, for which Sphinx needs a page.
    for path in sorted(path for path in listed if not (folder / path).exists()):
        write_text(folder / path, listing(path.parent))
    first = read_text(Path(README)) + "\n" + "\n".join(menus(index, MADE))
    write_text(folder / README, first)
    for place, words in read_yaml(SEARCHED).items():
        name, _, heading = place.partition("#")
        write_text(folder / name, with_words(read_text(folder / name), heading, words, f"{SEARCHED}: {place}"))
    for page in sorted(folder.rglob("*.md")):
        write_text(page, relinked(read_text(page), page.relative_to(folder), folder))
    shutil.move(folder / README, folder / FIRST)


def trial_pages() -> Iterator[tuple[str, str]]:
    """Yield the page of each trial, whose table stands alone in its file, and the page that lists them."""
    tables = sorted(TRIALS.glob("*.md"))
    for table in tables:
        yield str(table), f"# {title_of(table)}\n\n`./reproduce {table.stem}` makes it.\n\n{table_in(read_text(table))}"
    listed = "".join(f"* [{title_of(table)}]({table.name})\n" for table in tables)
    hidden = "".join(f"{table.stem}\n" for table in tables)
    yield str(TRIALS / README), f"# Trials\n\n{listed}\n```{{toctree}}\n:hidden:\n\n{hidden}```\n"


def listing(folder: Path) -> str:
    """Return the page of a folder that has none: its files."""
    files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return f"# Files of {folder}\n\n" + "".join(f"* [{path}]({path})\n" for path in files)


def title_of(table: Path) -> str:
    """Return the title of a trial's table."""
    return f"Trial: {table.stem.replace('_', ' ')}"


def modules_of(modules: Sequence[Path]) -> dict[str, list[str]]:
    """Return public package -> the dotted names of its modules, but those that are run or say what a package is."""
    names = [".".join(path.with_suffix("").parts[1:]) for path in modules if not path.stem.startswith("__")]
    found: dict[str, list[str]] = {}
    for package in PUBLIC:
        found[package] = [name for name in names if name.startswith(f"mobnet.{package}.")]
    return found


def with_words(text: str, heading: str, words: Sequence[str], name: str) -> str:
    """Return the text of a page with words for the search behind a heading, or behind its title if that is empty.

    Raises:
        DataError: the page has no such heading.
    """
    lines = text.splitlines()
    for row, line in enumerate(lines):
        title = re.match(r"#+ +(.+)", line)
        if title and heading in ("", anchor_of(title[1])):
            # Main entries of the index stand above all else that a search finds.
            entries = ", ".join(f"! {word}" for word in words)
            lines.insert(row + 1, f"\n```{{index}} {entries}\n```")
            return "\n".join(lines) + "\n"
    raise DataError(f"{name}: the page has no such heading; accepted: a heading as it is in links to it")


def anchor_of(title: str) -> str:
    """Return the name of a heading in links to it, as code hosts make it."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def relinked(text: str, page: Path, folder: Path) -> str:
    """Return the text of a page, whose links to folders lead to their own pages, and those to the README to the first.

    A linked file of the project that Sphinx does not read yet is copied into the folder.
    """

    def target(link: re.Match[str]) -> str:
        path = Path(posixpath.normpath(page.parent / link[0]))
        if str(path) == README:
            return posixpath.relpath(FIRST, page.parent)
        if (folder / path).is_dir():
            return f"{link[0]}/{README}"
        if not (folder / path).exists() and path.is_file():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, folder / path)
        return link[0]

    return LINK.sub(target, text)


def step_of(said: Path) -> str:
    """Return what Sphinx is doing, from what it has said: step, share of the pages, page."""
    last = last_line(said)
    return f"Sphinx: {last}" if "%]" in last else "Sphinx"


def build(folder: Path, out: Path) -> Path:
    """Let Sphinx build a folder, whose every warning is an error; return `out`.

    Raises:
        DataError: what Sphinx says, with paths from the folder.
    """
    words = [sys.executable, "-m", "sphinx", "--no-color", "-W", "--keep-going", "-E", "-b", "html"]
    words += ["-d", str(out.with_name("doctrees")), str(folder), str(out)]
    # Packages imported for their docstrings leave caches in the temporary folder: it is one that goes with the build.
    fixed = {**os.environ, **FIXED, "TMPDIR": str(folder.parent)}
    said = folder.with_name("sphinx.log")  # as it works for minutes, its progress is told
    with said.open("w") as file, telling(log, lambda: step_of(said)):
        done = subprocess.run(words, stdout=file, stderr=subprocess.PIPE, text=True, check=False, env=fixed)
    if done.returncode:
        raise DataError(done.stderr.replace(f"{folder}/", "").strip() or f"sphinx ended with {done.returncode}")
    for left in (".buildinfo", ".buildinfo.bak", "objects.inv"):  # nobody reads them here
        (out / left).unlink(missing_ok=True)
    for page in out.rglob("*.html"):
        write_text(page, accessible(read_text(page)))
    return out


def accessible(page: str) -> str:
    """Return a page of the theme with names for its landmarks, and with tables and code that scroll by the keyboard."""
    if "sidebar-drawer" not in page:  # a page of its own, such as explore.html
        return page
    for written, wanted in ACCESSIBLE.items():
        page = page.replace(written, wanted)
    return page
