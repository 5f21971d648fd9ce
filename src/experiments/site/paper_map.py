"""The map docs/map.md from every item of the paper to its rule, function, files and test, generated from the plan.

`python -m experiments.site map` writes it; a test fails when it is out of date.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.heads import CAPTIONS
from experiments.plan.plan import Plan, make_plan
from experiments.plan.product import Product
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import write_text
from mobnet.formats.base import Section
from mobnet.formats.faults import validated
from mobnet.formats.reading import Document

MAP = Path("docs/map.md")
SOURCE = Path("workflow/report/map.yaml")
NUMBERED = re.compile(r"(table|figure)_0?(\d+)")
KINDS = ("Table", "Figure", "Equation", "Section")
ITEM = re.compile(rf"({'|'.join(KINDS)}) \(?([\d.]*\d)")  # Table 7, Equation (18), Section 4.2.3
TITLED = re.compile(r"^(Table|Figure) \d+: ")  # the start of a caption's title that the paper's item has too
OURS = " (ours)"  # at the end of a caption's title
READ = (".md", ".pdf")  # endings of files that people read
SHOWN = 3  # files of a product that are named
TESTS = Path("tests")
PAGES = Path("tests/world/pages")  # tests of what a browser shows
HEADER = ("original", "what it shows", "command", "further files", "test", "rule and function")
HEAD = f"""# Map of the original

Generated from the plan, the captions and `{SOURCE}` by
`python -m experiments.site map`: do not edit.
The first table lists every table, figure and evaluated section of the original, the second what this repository adds.
A command makes the file that it names, at the main scale, with the other endings (.csv, .tex, .pdf, .svg, .png) beside
it. Then come further files, the test in `{TESTS}`, and the rule with the function in `src/experiments/evaluation` that
it calls. Where the numbers of a table are inputs, a key of the configuration holds them. The third table lists systems
and scenarios.
"""


class Input(Section):
    """A table of the paper whose numbers are inputs: what it shows, and the key of the configuration in a file."""

    shows: str
    file: str
    key: str


class System(Section):
    """A system or a scenario of the paper: where it is, and its tests, as Markdown."""

    paper: str
    here: str
    tests: str


class MapNotes(Section):
    """What only a person knows.

    Attributes:
        inputs: item of the paper -> where its numbers stand.
        paper: product -> its items of the paper, beside the number that its name has.
        shows: product -> what it shows, where no caption says it.
        tests: test -> the products or functions that it is of, where it does not have the product's name.
        systems: of the paper, and of ours.
    """

    inputs: Mapping[str, Input]
    paper: Mapping[str, str]
    shows: Mapping[str, str]
    tests: Mapping[str, tuple[str, ...]]
    systems: tuple[System, ...]


def renew() -> None:
    """Write the map of the repository."""
    plan = make_plan(load_settings(overrides={"scale": "default"}), with_pdf=True, with_mp4=True)
    write_text(MAP, paper_map(plan, read_known(SOURCE)))


def read_known(path: Path) -> MapNotes:
    """Read what only a person knows.

    Raises:
        ConfigError: a key or a value is not accepted; one line for each of them.
    """
    document = Document(path)
    return validated(MapNotes, document.values, document.values, document.told)


def paper_map(plan: Plan, known: MapNotes) -> str:
    """Return the map of a plan as Markdown.

    Raises:
        ConfigError: a product has no title or no test, or there is no such product.
    """
    products = (*plan.products, *plan.trials, *plan.films, *plan.docs)
    _check_names(known, products)
    tests: dict[str, Path] = {}
    for path, names in known.tests.items():
        tests |= dict.fromkeys(names, Path(path))
    rows = [[item, row.shows, "-", f"`{row.file}`", "-", f"`{row.key}`"] for item, row in known.inputs.items()]
    ours: list[list[str]] = []
    for product in products:
        item = paper_item(product.name, known.paper)
        test = test_of(product, tests).relative_to(TESTS)
        made_by = f"`{product.rule}`: `{_function(product)}`"
        read = [name for name in product.outputs if name.endswith(READ)]
        first = [*read, *product.outputs][0]
        # Files of the same name and another ending are beside the first one.
        further = [name for name in product.outputs if Path(name).with_suffix("") != Path(first).with_suffix("")]
        command = f"`./reproduce {first}`"
        row = [item, shows(product, known.shows), command, files_of(further) or "-", f"`{test}`", made_by]
        if item:
            rows.append(row)
        else:
            ours.append(row[1:])
    rows.sort(key=lambda row: _place(row[0]))
    systems = [[row.paper, row.here, row.tests] for row in known.systems]
    tables = {
        "Tables, figures and sections": markdown_table(HEADER, rows, left=len(HEADER)),
        "What this repository adds": markdown_table(HEADER[1:], ours, left=len(HEADER) - 1),
        "Systems and scenarios": markdown_table(["original", "here", "tests"], systems, left=3),
    }
    return HEAD + "".join(f"\n## {title}\n\n{table}" for title, table in tables.items())


def paper_item(name: str, known: Mapping[str, str]) -> str:
    """Return the items of the paper that a product has, nothing for one of ours."""
    items: list[str] = []
    if number := NUMBERED.fullmatch(name):
        items.append(f"{number[1].capitalize()} {number[2]}")
    if name in known:
        items.append(known[name])
    return ", ".join(items)


def shows(product: Product, known: Mapping[str, str]) -> str:
    """Return what a product shows: what is known of it, or the titles of the captions of its files."""
    if product.name in known:
        return known[product.name]
    titles: list[str] = []
    for stem in dict.fromkeys(Path(name).stem for name in product.outputs):
        for caption in sorted(CAPTIONS.glob(f"*/{stem}.rst")):
            title = caption.read_text(encoding="utf-8").splitlines()[0]
            titles.append(TITLED.sub("", title).removesuffix(OURS))
    if not titles:
        raise ConfigError(f"{SOURCE}: shows: {product.name!r} is missing; accepted: a text here, or a caption")
    return "; ".join(dict.fromkeys(titles))


def files_of(outputs: Iterable[str]) -> str:
    """Return the files of a product, those that differ in nothing but their endings together."""
    endings: dict[str, list[str]] = {}
    for name in outputs:
        path = Path(name)
        endings.setdefault(path.with_suffix("").as_posix(), []).append(path.suffix)
    texts: list[str] = []
    for stem, (first, *others) in endings.items():
        texts.append(", ".join([f"`{stem}{first}`", *others]))
    if len(texts) > SHOWN:
        texts[SHOWN:] = [f"{len(texts) - SHOWN} more"]
    return "; ".join(texts)


def test_of(product: Product, known: Mapping[str, Path]) -> Path:
    """Return the test of a product or of its function, if it is known, or that of its name in the package's tests."""
    for name in (product.name, _function(product)):
        if name in known:
            return known[name]
    package = product.call.late().__module__.split(".")[1:3]
    test = Path("tests", "paper", *package, f"test_{product.name}.py")
    if (PAGES / test.name).is_file():
        return PAGES / test.name
    if not test.is_file():
        raise ConfigError(f"{SOURCE}: tests: {product.name!r} is missing; accepted: its test here, or {test}")
    return test


def _function(product: Product) -> str:
    """Return the name of the function that makes a product, without its module."""
    return product.call.late().__name__


def _check_names(known: MapNotes, products: Iterable[Product]) -> None:
    """Refuse what is known of products that do not exist."""
    names: list[str] = []
    for product in products:
        names += [product.name, _function(product)]
    tested: list[str] = []
    for test in known.tests.values():
        tested += test
    for section, given in (("paper", known.paper), ("shows", known.shows), ("tests", tested)):
        for name in given:
            if name not in names:
                raise ConfigError(f"{SOURCE}: {not_accepted(section, name, dict.fromkeys(names))}")


def _place(item: str) -> tuple[int, list[int]]:
    """Return the place of an item of the paper: tables, figures, equations and sections, each by its number."""
    if found := ITEM.search(item):
        return KINDS.index(found[1]), [int(part) for part in found[2].split(".")]
    return len(KINDS), []
