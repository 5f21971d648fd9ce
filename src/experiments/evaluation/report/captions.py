r"""Captions of tables and figures: reStructuredText with numbers of the results, as TeX and as plain text.

A field is a macro of the paper's prose: `{found:rte-walk}` is `\found{rte-walk}`, and `MACROS` has them all. Several
arguments of a macro are separated by semicolons. The guards `{holds:claim;verdict,...}` and `{below:cell;cell}` stand
behind words that depend on results and print a dagger where these turned.

The paper prints the title and the first paragraph without a field, which says what is drawn: what follows from it, the
paragraphs with fields, is what the paper's text says, and what is after it are details for the report.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

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
MARKUP = re.compile(rf"``(?P<code>.+?)``|\*\*(?P<bold>.+?)\*\*|\*(?P<italic>.+?)\*|(?P<field>{FIELD.pattern})")
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
HOLDS, BELOW = "holds", "below"
DAGGER = "\N{DAGGER}"
TURNED = f"\n\n{DAGGER} The results shown here do not bear out this sentence.\n"


def captions_tex(files: Sequence[Path], values: Mapping[str, str]) -> str:
    r"""Return TeX that defines \capt{tables/NAME} and \capt{figures/NAME}: the title in bold, then the text.

    `files` are those of `workflow/report`: a title, an empty line, and paragraphs with ``code``, *emphasis*, **bold**
    and fields; `values`: name -> text of the numbers that fields may name.

    Raises:
        DataError: a file is missing, has no text or a single backtick, or names a number that is none.
    """
    texts = {f"{path.parent.name}/{path.stem}": caption_tex(path, values) for path in files}
    lines = (rf"\expandafter\def\csname capt@{name}\endcsname{{{text}}}" + "\n" for name, text in texts.items())
    return HEAD + "".join(lines)


def caption_tex(path: Path, values: Mapping[str, str]) -> str:
    """Return the caption of a file as TeX: title and what is drawn. Guards, which print a dagger there, stay macros."""
    title, _, text = filled(path, values, keep_fields=True).partition("\n")
    words = cited(QUOTED.sub(r"``\1''", inline_tex(drawn(text))), path.parents[1])
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
    for found in MARKUP.finditer(text):
        done += tex_escape(text[end : found.start()])
        if found["field"]:
            done += rf"\{found['macro']}" + "".join(f"{{{name}}}" for name in found["names"].split(";"))
        else:
            kind = next(kind for kind in COMMANDS if found[kind])
            done += rf"\{COMMANDS[kind]}{{{tex_escape(found[kind])}}}"
        end = found.end()
    return done + tex_escape(text[end:])


def fill_captions(files: Sequence[Path], values: Mapping[str, str], folder: Path) -> None:
    """Write captions with their numbers into a folder, below the name of the folder that each comes from."""
    for path in files:
        write_text(folder / path.parent.name / path.name, filled(path, values))


def filled(path: Path, values: Mapping[str, str], *, keep_fields: bool = False) -> str:
    """Return the text of a caption with its numbers, and what a dagger means where a guard turned.

    Raises:
        DataError: the file is missing, has no text or a single backtick, or names a number that is none.
    """
    raw = read_text(path)
    if not raw.partition("\n")[2].strip():
        raise DataError(f"{path}: no text below the title")
    if alone := re.search(r"\S*(?<!`)`(?!`)\S*", raw):
        raise DataError(f"{path}: {alone[0]!r} is not accepted; accepted: ``code`` in double backticks")
    # A line may break within a field, whose name has single spaces then.
    text = FIELD.sub(lambda field: f"{{{field['macro']}:{' '.join(field['names'].split())}}}", raw)
    plain = FIELD.sub(lambda field: field_text(path, field["macro"], field["names"], values), text)
    if keep_fields:
        return text
    plain = re.sub(r"^ +", "", plain, flags=re.MULTILINE)  # after an empty field, as an indented line is a quotation
    return plain.rstrip() + TURNED if DAGGER in plain else plain


def field_text(path: Path, macro: str, names: str, values: Mapping[str, str]) -> str:
    """Return what a field stands for, of a caption that is named where it fails."""
    given = names.split(";")
    if macro in (HOLDS, BELOW):
        if len(given) != 2:
            raise DataError(
                f"{path}: {{{macro}:{names}}} is not accepted; accepted: two names with a semicolon between"
            )
        looked_up = [f"verdict@{given[0]}"] if macro == HOLDS else [f"cell@{name}" for name in given]
    elif macro not in MACROS or MACROS[macro].count("#") != len(given):
        raise DataError(f"{path}: {{{macro}:{names}}} is not accepted; accepted: {', '.join([*MACROS, HOLDS, BELOW])}")
    else:
        looked_up = [named(MACROS[macro], given)]
    missing = [name for name in looked_up if name not in values]
    if missing:
        raise DataError(f"{path}: {{{macro}:{names}}}: no table has {missing[0]!r}; accepted: a name of numbers.tex")
    if macro in (HOLDS, BELOW):
        return "" if guard_holds(macro, given[0], given[1], values) else DAGGER
    return values[looked_up[0]]


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


def guard_holds(macro: str, first: str, second: str, values: Mapping[str, str]) -> bool:
    """Return whether a claim has one of some verdicts, or whether the first cell's number is below the second one's."""
    if macro == HOLDS:
        return values.get(f"verdict@{first}") in [one.strip() for one in second.split(",")]
    low, high = (values.get(f"value@{name}") for name in (first, second))
    return low is not None and high is not None and float(low) < float(high)
