"""Links of Markdown and HTML files: those that lead to no file or to no place in it."""

import re
from collections.abc import Iterable, Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINK = re.compile(r"(?<!`)\[[^]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#{1,6} +(.+?) *#*$", re.MULTILINE)
CODE = re.compile(r"^(?:```.*?^```|(?: {4}|\t).*?)$", re.MULTILINE | re.DOTALL)
LINKED = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "srcset", "iframe": "src"}


class Page(HTMLParser):
    """The links of an HTML page, and the names of the places in it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links, self.places = list[str](), {""}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.places |= {given[name] for name in ("id", "name") if name in given}
        if LINKED.get(tag) in given:
            self.links.append(given[LINKED[tag]].split(" ")[0])


class Document:
    """The links of a Markdown document, and the names of its headings, as code hosts give them."""

    def __init__(self, text: str) -> None:
        prose = CODE.sub("", text)
        self.links = LINK.findall(prose)
        self.places = {""}
        for title in HEADING.findall(re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)):
            name = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", title).lower()).replace(" ", "-")
            same = sum(re.fullmatch(rf"{re.escape(name)}(-\d+)?", place) is not None for place in self.places)
            self.places.add(f"{name}-{same}" if same else name)


@cache
def read(path: Path) -> Page | Document:
    text = path.read_text(encoding="utf-8")
    return Page(text) if path.suffix == ".html" else Document(text)


def broken(paths: Iterable[Path]) -> Iterator[str]:
    """Yield one line for each link within the project that leads nowhere."""
    for path in paths:
        for link in dict.fromkeys(read(path).links):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            if not target.exists():
                yield f"{path}: {link}: there is no such file"
            elif "=" in parts.fragment:
                continue  # the state of a page, which its script reads
            elif target.suffix in (".html", ".md") and unquote(parts.fragment) not in read(target).places:
                yield f"{path}: {link}: there is no such place in it"


def outside(paths: Iterable[Path]) -> set[str]:
    """Return what pages load from elsewhere: scripts, styles, fonts and pictures."""
    loaded = re.compile(r"<(?:script|img|source|iframe|link)[^>]*?(?:src|href)=[\"']?((?:https?:)?//[^\"'> ]+)")
    styles = re.compile(r"(?:url\(|@import)\s*[\"']?((?:https?:)?//[^\"') ]+)")
    found = set[str]()
    for path in paths:
        text = path.read_text(encoding="utf-8")
        found |= set((styles if path.suffix == ".css" else loaded).findall(text))
    return found
