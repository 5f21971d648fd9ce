"""Captions of tables and figures as TeX, from the files that the report shows, so that each is written once."""

import re
from collections.abc import Iterable
from pathlib import Path

from experiments.evaluation.tables.layout import tex_escape
from mobnet.core.errors import DataError
from mobnet.core.files import read_text

PRINTED = re.compile(r"^(?:Figure|Table) \d+: ")  # of the paper that is reproduced: ours have numbers of their own
OURS = re.compile(r" \(ours\)$")
MARKUP = re.compile(r"``(?P<code>.+?)``|\*\*(?P<bold>.+?)\*\*|\*(?P<italic>.+?)\*")
COMMANDS = {"code": "texttt", "bold": "textbf", "italic": "emph"}
HEAD = r"""\newcommand{\capt}[1]{\ifcsname capt@#1\endcsname\csname capt@#1\endcsname
  \else\errmessage{captions.tex has no #1}\fi}
"""


def captions_tex(files: Iterable[Path]) -> str:
    r"""Return TeX that defines \capt{tables/NAME} and \capt{figures/NAME}: the title in bold, then the text.

    `files` are those of `workflow/report`: a title, an empty line, and paragraphs with ``code``, *emphasis* and
    **bold**.

    Raises:
        DataError: a file is missing, or has no text below its title.
    """
    texts = {f"{path.parent.name}/{path.stem}": caption_tex(path) for path in files}
    lines = (rf"\expandafter\def\csname capt@{name}\endcsname{{{text}}}" + "\n" for name, text in texts.items())
    return HEAD + "".join(lines)


def caption_tex(path: Path) -> str:
    """Return the caption of a file as TeX."""
    title, _, text = read_text(path).partition("\n")
    words = " ".join(text.split())
    if not words:
        raise DataError(f"{path}: no text below the title")
    bare = OURS.sub("", PRINTED.sub("", title.strip()))
    return rf"\textbf{{{inline_tex(bare[:1].upper() + bare[1:])}.}} {inline_tex(words)}"


def inline_tex(text: str) -> str:
    """Return a line of reStructuredText as TeX."""
    done = ""
    end = 0
    for found in MARKUP.finditer(text):
        kind = found.lastgroup or ""
        done += tex_escape(text[end : found.start()]) + rf"\{COMMANDS[kind]}{{{tex_escape(found[kind])}}}"
        end = found.end()
    return done + tex_escape(text[end:])
