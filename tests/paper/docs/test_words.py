"""No text uses a word of the list that the glossary replaces: documents, captions, claims, blocks of the README."""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
import yaml

from experiments.evaluation.report import readme
from experiments.settings.load import load_settings

ROOT = Path(__file__).parents[3]
LIST = yaml.safe_load((Path(__file__).parent / "words.yaml").read_text())
DOCUMENTS = (
    "README.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "paper/README.md",
    "paper/main.tex",
    "docs/*.md",
    "docs/notes/*.md",
)
CAPTIONS = ("workflow/report/*.rst", "workflow/report/*/*.rst")
CODE = re.compile(r"^```.*?^```|^ {4,}\S.*?$|`[^`\n]*`|\]\([^)]*\)", re.MULTILINE | re.DOTALL)
MACROS = re.compile(r"\\[a-z]+(?:\{[\w@, -]*\})+")  # of TeX, with names of numbers
SHOWN = ("FINDINGS", "METHODS", "COLUMNS")  # texts of the README's blocks


@cache
def all_texts() -> tuple[tuple[str, str], ...]:
    """Return place and text of everything that people read here, without names and code."""
    return tuple(texts())


def texts() -> Iterator[tuple[str, str]]:
    """Yield them."""
    for pattern in (*DOCUMENTS, *CAPTIONS):
        for path in sorted(ROOT.glob(pattern)):
            text = path.read_text(encoding="utf-8")
            if path.name == "README.md" and path.parent == ROOT:  # its blocks are made of published results
                text = re.sub(r"<!-- (\w+) -->.*?<!-- /\1 -->", "", text, flags=re.DOTALL)
            if path.suffix == ".tex":
                text = MACROS.sub("", text)
            yield str(path.relative_to(ROOT)), CODE.sub("", text) if path.suffix == ".md" else text
    for name, claim in load_settings().claims.items():
        yield f"configs/claims.yaml: {name}", f"{claim.says}\n{claim.cause}"
    for name in SHOWN:
        yield f"readme.{name}", str(getattr(readme, name))


def places(word: str) -> Iterator[str]:
    """Yield each place of a word, with what stands around it."""
    for place, text in all_texts():
        for found in re.finditer(rf"\b(?:{word})\b", text, re.IGNORECASE):
            around = " ".join(text[max(0, found.start() - 40) : found.end() + 20].split())
            yield f"{place}: ... {around} ..."


@pytest.mark.parametrize("row", LIST, ids=lambda row: row["word"])
def test_no_text_uses_a_word_of_the_list(row):
    assert list(places(row["word"])) == [], f"write {row['instead']}: {row['why']}"


def test_every_row_says_what_is_written_instead_and_why():
    assert all(row.keys() == {"word", "instead", "why"} and all(row.values()) for row in LIST)
    assert len({row["word"] for row in LIST}) == len(LIST)


@pytest.mark.parametrize(("text", "is_found"), [
    ("MOB errs by 2 N m", True),
    ("The gray box", True),
    ("MOB-Net-gray is grey", False),
    ("What is left of it", True),
    ("a better one", False),
    ("errors", False),
])  # fmt: skip
def test_the_list_finds_words_and_not_their_parts(text, is_found):
    assert any(re.search(rf"\b(?:{row['word']})\b", text, re.IGNORECASE) for row in LIST) == is_found


def test_the_glossary_defines_each_word_once():
    words = re.findall(r"^\| ([^|]+) \| [A-Z]", (ROOT / "docs" / "glossary.md").read_text(), re.MULTILINE)
    assert 20 <= len(words) <= 45
    assert len(set(words)) == len(words)
