"""Blocks of documents that are made: what stands between a mark and its end."""

from pathlib import Path

from mobnet.core.errors import DataError


def with_block(text: str, name: str, block: str, page: Path) -> str:
    """Return the text of a page with a block between its marks, which it must have.

    Raises:
        DataError: the page has no such marks.
    """
    first = f"<!-- {name} -->\n"
    last = f"<!-- /{name} -->"
    if first not in text or last not in text:
        raise DataError(f"{page}: the marks {first.strip()!r} and {last!r} are missing")
    return text[: text.index(first)] + first + block.strip() + "\n" + text[text.index(last) :]
