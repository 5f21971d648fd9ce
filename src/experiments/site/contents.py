"""The contents of the documentation: the sections of docs/README.md, its groups and their order."""

import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from mobnet.core.errors import DataError

SECTION, GROUP = re.compile(r"^## (.+)$", re.MULTILINE), re.compile(r"^### (.+)$", re.MULTILINE)
ROW = re.compile(r"^\| \[[^]]*\]\(([^)#]+)\) \|", re.MULTILINE)
FOLDER, PAGE, README = "docs", "README", "README.md"  # folder of the index, page of a folder, first page of all


class Group(NamedTuple):
    """Documents of a section below a heading of their own: its title, its text, and the documents from the root."""

    title: str
    text: str
    documents: tuple[str, ...]

    @property
    def path(self) -> str:
        """Path of its page from the root."""
        return f"{FOLDER}/{re.sub(r'[^a-z0-9]+', '-', self.title.lower())}.md"

    @property
    def page(self) -> str:
        """Its page: the index's text, and its documents as entries of the menu."""
        return f"# {self.title}\n{self.text.rstrip()}\n\n{menu(self.documents)}"


class IndexSection(NamedTuple):
    """A section of the index: its documents from the root, and its groups."""

    documents: tuple[str, ...]
    groups: tuple[Group, ...]


def sections(index: str) -> dict[str, IndexSection]:
    """Return title -> section of the index.

    Raises:
        DataError: the index has no section.
    """
    _, *parts = SECTION.split(index)
    if not parts:
        raise DataError(f"{FOLDER}/{README}: no section is found; accepted: headings of level 2 with tables of links")
    found: dict[str, IndexSection] = {}
    for title, text in zip(parts[::2], parts[1::2], strict=True):
        own, *grouped = GROUP.split(text)
        pairs = zip(grouped[::2], grouped[1::2], strict=True)
        found[title] = IndexSection(_documents(own), tuple(Group(name, part, _documents(part)) for name, part in pairs))
    return found


def menus(index: str, added: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Yield the menu of each section: pages that are made (`added`), its documents, and its groups.

    Raises:
        DataError: pages are made for a section that the index does not have.
    """
    found = sections(index)
    if missing := [title for title in added if title not in found]:
        raise DataError(f"{FOLDER}/{README}: section {missing[0]!r} is missing; it has {', '.join(found)}")
    for title, section in found.items():
        yield menu([*section.documents, *added.get(title, ()), *(group.path for group in section.groups)], title)


def menu(documents: Iterable[str], title: str = "") -> str:
    """Return a menu of documents: entries at the side, none in the text."""
    caption = f":caption: {title}\n" if title else ""
    lines = "".join(f"/{path.removesuffix('.md')}\n" for path in documents)
    return f"```{{toctree}}\n:hidden:\n{caption}\n{lines}```\n"


def _documents(text: str) -> tuple[str, ...]:
    """Return the documents that tables link, from the root and each once; a folder is its own page."""
    linked = (posixpath.normpath(f"{FOLDER}/{path}") for path in ROW.findall(text))
    pages = (path if path.endswith(".md") else f"{path}/{PAGE}.md" for path in linked)
    return tuple(dict.fromkeys(page for page in pages if page != README))
