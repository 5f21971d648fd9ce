r"""Captions of tables and figures: reStructuredText with numbers of the results, as TeX and as plain text.

A caption is a template of Jinja. A field is a macro of the paper's prose: `{{ found("rte-walk") }}` is
`\found{rte-walk}`, and `MACROS` has them all. The guards `{{ holds("claim", "verdict", ...) }}` and
`{{ below("cell", "cell") }}` stand behind words that depend on results and print a dagger where these turned.

The paper prints the title and the first paragraph without a field, which says what is drawn: what follows from it, the
paragraphs with fields, is what the paper's text says, and what is after it are details for the report.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from jinja2 import TemplateSyntaxError, UndefinedError

from experiments.evaluation.report import html
from experiments.evaluation.tables.layout import tex_escape
from experiments.plan.heads import FIELD, drawn
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text

# Titles name the item of the original that is made again, and its section; in the paper ours have numbers of their own.
PRINTED = re.compile(r"^(?P<item>(?P<kind>Figure|Table) (?P<number>\d+))(?:, [^:]+)?: ")
ASIDE = re.compile(r" \((?:ours|(?:ours, after )?section [\d.]+)\)$")
ITEM = re.compile(
    r"\b(?P<kind>[Ss]ections?|[Ee]quation|[Tt]able|[Ff]igure|loss) (?P<number>\d+(?:\.\d+)*(?: to \d+)?|\(\d+\))"
    r"(?P<theirs> of the original(?: \(section [\d.]+\))?)?"
)
THEIRS = re.compile(r"[Tt]he original's ((?:Table|Figure|section) \d+(?:\.\d+)*)")
QUOTED = re.compile(r'"([^"]*)"')
CITED = r"~of~\cite{lim2023mobnet}"
MARKUP = re.compile(r"``(?P<code>.+?)``|\*\*(?P<bold>.+?)\*\*|\*(?P<italic>.+?)\*")
COMMANDS = {"code": "texttt", "bold": "textbf", "italic": "emph"}
CALL = re.compile(r"\\(?P<macro>\w+)(?P<given>(?:\{[^{}]*\})+)")  # of a macro in TeX
HEAD = r"""\newcommand{\capt}[1]{\ifcsname capt@#1\endcsname\csname capt@#1\endcsname
  \else\errmessage{captions.tex has no #1}\fi}
"""
MACROS = {  # name -> name of the text that it looks up, # being its arguments in their order
    "ourcell": "ours@#@#@#@#@#",
    "publishedcell": "published@#@#@#@#@#",
    "ours": "ours@forward_walk@#@#@#@rmse",
    "published": "published@forward_walk@#@#@#@rmse",
    "cell": "cell@#",
    "cellspan": "cellspan@#",
    "cellshare": "cellshare@#",
    "cellsharespan": "cellsharespan@#",
    "claimed": "claimed@#",
    "found": "found@#",
    "foundspan": "span@#",
    "claimedshare": "claimedshare@#",
    "foundshare": "foundshare@#",
    "claimedrange": "claimedrange@#",
    "signrange": "signrange@#",
    "verdict": "verdict@#",
    "cause": "cause@#",
    "scored": "scored@#@#",
    "firsts": "firsts@#@#",
    "counted": "counted@#@#",
    "size": "size@#",
}
DAGGER = "\N{DAGGER}"
TURNED = f"\n\n{DAGGER} The results shown here do not bear out this sentence.\n"


def captions_tex(files: Sequence[Path]) -> str:
    r"""Return TeX that defines \capt{tables/NAME} and \capt{figures/NAME}: the title in bold, then the text.

    `files` are those of `workflow/report`: a title, an empty line, and paragraphs with ``code``, *emphasis*, **bold**
    and fields.

    Raises:
        DataError: a file is missing, has no text, no paragraph without a field, or a single backtick.
    """
    texts = {f"{path.parent.name}/{path.stem}": caption_tex(path) for path in files}
    lines = (rf"\expandafter\def\csname capt@{name}\endcsname{{{text}}}" + "\n" for name, text in texts.items())
    return HEAD + "".join(lines)


def caption_tex(path: Path) -> str:
    """Return the caption of a file as TeX: title and what is drawn.

    Raises:
        DataError: no paragraph says so without a field.
    """
    title, _, text = written(path).partition("\n")
    paragraph = drawn(text)
    if FIELD in paragraph:
        raise DataError(f"{path}: every paragraph has a field; accepted: one without, which says what is drawn")
    words = cited(QUOTED.sub(r"``\1''", inline_tex(paragraph)), path.parents[1])
    bare = ASIDE.sub("", PRINTED.sub("", title.strip()))
    printed = PRINTED.match(title)
    after = f"After {printed['kind']}~{printed['number']}{CITED}." if printed else ""
    if after.removesuffix(".").removeprefix("After ") in words:
        after = ""
    return rf"\textbf{{{inline_tex(bare[:1].upper() + bare[1:])}.}} {words} {after}".rstrip()


def cited(text: str, folder: Path) -> str:
    """Return TeX in which sections, equations, tables and figures of the original cite it.

    A table or figure that is not said to be the original's is ours where the folder of captions has it.
    """

    def item_tex(item: re.Match[str]) -> str:
        kind, number = item["kind"], item["number"]
        own = f"{kind.lower()}_{number:0>2}"
        if not item["theirs"] and (folder / f"{kind.lower()}s" / f"{own}.rst").is_file():
            return rf"{kind}~\ref{{{kind[:3].lower()}:{own}}}"
        return f"{kind}~{number}{CITED}"

    return ITEM.sub(item_tex, THEIRS.sub(r"\1 of the original", text))


def inline_tex(text: str) -> str:
    """Return a line of reStructuredText as TeX."""
    done = ""
    end = 0
    for mark in MARKUP.finditer(text):
        kind = next(kind for kind in COMMANDS if mark[kind])
        done += tex_escape(text[end : mark.start()])
        done += rf"\{COMMANDS[kind]}{{{tex_escape(mark[kind])}}}"
        end = mark.end()
    return done + tex_escape(text[end:])


def fill_captions(files: Sequence[Path], values: Mapping[str, str], folder: Path) -> None:
    """Write captions with their numbers into a folder, below the name of the folder that each comes from."""
    for path in files:
        write_text(folder / path.parent.name / path.name, filled(path, values))


def written(path: Path) -> str:
    """Return a caption as it is written, with its fields.

    Raises:
        DataError: the file is missing, or has no text or a single backtick.
    """
    text = read_text(path)
    if not text.partition("\n")[2].strip():
        raise DataError(f"{path}: no text below the title")
    if alone := re.search(r"\S*(?<!`)`(?!`)\S*", text):
        raise DataError(f"{path}: {alone[0]!r} is not accepted; accepted: ``code`` in double backticks")
    return text


def filled(path: Path, values: Mapping[str, str]) -> str:
    """Return the text of a caption with its numbers, and what a dagger means where a guard turned.

    Args:
        path: file of the caption.
        values: name -> text of the numbers that fields may name.

    Raises:
        DataError: the file is missing, has no text or a single backtick, or names a number that is none.
    """
    written(path)
    functions = fields(values)
    try:
        text = html.filled(path, functions)
    except UndefinedError as fault:
        raise DataError(f"{path}: {fault.message}; accepted: {', '.join(functions)}") from None
    except TemplateSyntaxError as fault:
        raise DataError(f"{path}, line {fault.lineno}: {fault.message}; accepted: a template of Jinja") from None
    except DataError as fault:
        raise DataError(f"{path}: {fault}") from None
    plain = re.sub(r"^ +", "", text, flags=re.MULTILINE)  # after an empty field, as an indented line is a quotation
    return plain.rstrip() + TURNED if DAGGER in plain else plain


def fields(values: Mapping[str, str]) -> dict[str, Callable[..., str]]:
    """Return the functions that captions call, macros and guards by their names, over name -> text of numbers."""
    macros = {macro: partial(number_text, values, macro) for macro in MACROS}
    return {**macros, "holds": partial(holds, values), "below": partial(below, values)}


def number_text(values: Mapping[str, str], macro: str, *arguments: str) -> str:
    """Return the number that a macro looks up."""
    pattern = MACROS[macro]
    return text_of(values, named(pattern, checked(macro, arguments, pattern.count("#"))))


def holds(values: Mapping[str, str], *words: str) -> str:
    """Return a dagger where a claim, the first word, has none of the verdicts that follow."""
    claim, *verdicts = checked("holds", words, max(len(words), 2))
    return "" if text_of(values, f"verdict@{claim}") in verdicts else DAGGER


def below(values: Mapping[str, str], *cells: str) -> str:
    """Return a dagger where the number of the first of two cells is not below the second one's."""
    first, second = checked("below", cells, 2)
    text_of(values, f"cell@{first}")
    text_of(values, f"cell@{second}")
    low, high = values.get(f"value@{first}"), values.get(f"value@{second}")
    return "" if low is not None and high is not None and float(low) < float(high) else DAGGER


def text_of(values: Mapping[str, str], name: str) -> str:
    """Return the text of a number.

    Raises:
        DataError: there is none of this name.
    """
    if name not in values:
        raise DataError(f"no table has {name!r}; accepted: a name of numbers.tex")
    return values[name]


def checked(macro: str, arguments: Sequence[str], count: int) -> list[str]:
    """Return the arguments of a field, each in one line.

    Raises:
        DataError: they are not as many as it takes.
    """
    if len(arguments) != count:
        given = ", ".join(f'"{argument}"' for argument in arguments)
        raise DataError(f"{macro}({given}): {len(arguments)} arguments are not accepted; accepted: {count}")
    return [" ".join(argument.split()) for argument in arguments]  # a line may break within a name


def names_in(text: str) -> list[str]:
    """Return the names of all numbers that a TeX text looks up by `MACROS`, each once."""
    found: list[str] = []
    for call in CALL.finditer(" ".join(text.split())):
        given = call["given"][1:-1].split("}{")
        pattern = MACROS.get(call["macro"], "")
        if pattern and pattern.count("#") == len(given):
            found.append(named(pattern, given))
    return list(dict.fromkeys(found))


def named(pattern: str, arguments: Sequence[str]) -> str:
    """Return a pattern with its arguments in place of each #."""
    first, *others = pattern.split("#")
    return first + "".join(argument + other for argument, other in zip(arguments, others, strict=True))
