"""Numbers of the paper's prose as TeX macros, so that a sentence cannot disagree with its table."""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.number.number import Number, interval_text, number_text
from experiments.evaluation.number.rows import read_numbers
from experiments.evaluation.report.main_tables import cell_text, cells_of, main_tables
from experiments.evaluation.tables.layout import tex_escape
from experiments.settings.scales import Scale
from experiments.settings.tables import MainTables
from mobnet.core.columns import CLAIMED
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text
from mobnet.core.rows import read_texts
from mobnet.settings.data import Recordings
from mobnet.settings.plant import Rates
from mobnet.settings.surrogate import Fleet

PRINTED = re.compile(r"^(?:Figure|Table) \d+: ")  # of the paper that is reproduced: ours have numbers of their own
OURS = re.compile(r" \(ours\)$")
MARKUP = re.compile(r"``(?P<code>.+?)``|\*\*(?P<bold>.+?)\*\*|\*(?P<italic>.+?)\*")
COMMANDS = {"code": "texttt", "bold": "textbf", "italic": "emph"}
HEAD = r"""\newcommand{\capt}[1]{\ifcsname capt@#1\endcsname\csname capt@#1\endcsname
  \else\errmessage{captions.tex has no #1}\fi}
"""
LOOKUP = r"""% Written by experiments.evaluation.report.numbers; do not edit.
\newcommand{\lookup}[1]{\ifcsname #1\endcsname\csname #1\endcsname\else\errmessage{numbers.tex has no #1}\fi}
\newcommand{\ourcell}[5]{\lookup{ours@#1@#2@#3@#4@#5}}
\newcommand{\publishedcell}[5]{\lookup{published@#1@#2@#3@#4@#5}}
\newcommand{\ours}[3]{\ourcell{forward_walk}{#1}{#2}{#3}{rmse}}
\newcommand{\published}[3]{\publishedcell{forward_walk}{#1}{#2}{#3}{rmse}}
\newcommand{\cell}[1]{\lookup{cell@#1}}
\newcommand{\cellspan}[1]{\lookup{cellspan@#1}}
\newcommand{\cellshare}[1]{\lookup{cellshare@#1}}
\newcommand{\cellsharespan}[1]{\lookup{cellsharespan@#1}}
\newcommand{\claimed}[1]{\lookup{claimed@#1}}
\newcommand{\found}[1]{\lookup{found@#1}}
\newcommand{\foundspan}[1]{\lookup{span@#1}}
\newcommand{\claimedshare}[1]{\lookup{claimedshare@#1}}
\newcommand{\foundshare}[1]{\lookup{foundshare@#1}}
\newcommand{\verdict}[1]{\lookup{verdict@#1}}
\newcommand{\cause}[1]{\lookup{cause@#1}}
\newcommand{\scored}[2]{\lookup{scored@#1@#2}}
\newcommand{\firsts}[2]{\lookup{firsts@#1@#2}}
\newcommand{\counted}[2]{\lookup{counted@#1@#2}}
\newcommand{\size}[1]{\lookup{size@#1}}
\newcommand{\turned}{\textsuperscript{$\dagger$}}
\makeatletter
\newcommand{\holds}[2]{\begingroup\edef\mobnet@now{\csname verdict@#1\endcsname}\let\mobnet@mark\turned
  \@for\mobnet@one:=#2\do{\ifx\mobnet@one\mobnet@now\let\mobnet@mark\relax\fi}\mobnet@mark\endgroup}
\newcommand{\below}[2]{\begingroup\let\mobnet@mark\turned\ifcsname value@#1\endcsname\ifcsname value@#2\endcsname
  \ifdim\csname value@#1\endcsname pt<\csname value@#2\endcsname pt\let\mobnet@mark\relax\fi\fi\fi
  \mobnet@mark\endgroup}
\makeatother
"""
MINUTE_S = 60.0
MILLION = 1e6


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


def numbers(
    scale: str,
    rates: Rates,
    sizes: Scale,
    fleet: Fleet,
    train: Recordings,
    table_csvs: Sequence[Path],
    further_csvs: Sequence[Path],
    claims_csv: Path,
    summary_csv: Path,
    captions: Sequence[Path],
    compared: MainTables,
    sources: Sequence[Path],
    out: Path,
) -> None:
    r"""Write what the paper's text takes: macros of numbers, captions.tex beside them, and the tables of the main text.

    \ourcell{scenario}{level}{method}{joint}{metric} and \publishedcell give a cell of a table of errors (metric: `mean`
    if it is the mean of some), \ours{level}{method}{joint} and \published a cell of Table 5. \cell{table@...} gives a
    number of any other table, by its columns before the number, \cellspan its interval, \cellshare and \cellsharespan
    those of a share [-] in %. \claimed{claim} gives the paper's number of a claim, \found and \foundspan ours and its
    interval, \claimedshare and \foundshare both in %, \verdict and \cause the judgement. \scored{score}{outcome} gives
    how many statements of a score have a verdict or another outcome of `claims_summary`, \firsts how many by their
    first claim alone, \counted how many claims; \size{name} gives sizes of the scale.

    Two guards stand behind sentences whose wording depends on results, and print a dagger where that turned:
    \holds{claim}{verdict,...} and \below{cell}{cell}, of \cell; `experiments.evaluation.report.paper` has more.

    Args:
        scale: name of the scale.
        rates: of the recordings.
        sizes: of the scale.
        fleet: the surrogate robots.
        train: recordings of random walking that networks learn from.
        table_csvs: tables of errors, columns `ERRORS`.
        further_csvs: other tables with a column `value`.
        claims_csv: judged claims.
        summary_csv: counts of verdicts.
        captions: files of `workflow/report`.
        compared: what the tables of the main text compare.
        sources: the tables that they are made from.
        out: file of the macros.
    """
    values = {f"size@{name}": text for name, text in size_texts(scale, rates, sizes, fleet, train).items()}
    for path in table_csvs:
        for of, number in read_numbers(path):
            values |= cell_texts(of, number)
    for path in further_csvs:
        for name, number in cells_of(path).items():
            values |= further_texts(name, number)
    for of, number in read_numbers(claims_csv):
        values |= claim_texts(of, number)
    for row in read_texts(summary_csv, CLAIMED):
        for name, of in (("scored", "statements"), ("firsts", "firsts"), ("counted", "claims")):
            values[f"{name}@{row['score']}@{row['outcome']}"] = row[of]
    # a TeX line defines one name, which may hold any character, as a text
    lines = (rf"\expandafter\def\csname {name}\endcsname{{{text}}}" + "\n" for name, text in values.items())
    write_text(out, LOOKUP + "".join(lines))
    write_text(out.with_name("captions.tex"), captions_tex(captions))
    main_tables(compared, sources, out.with_name("legs.csv"))


def cell_texts(of: Mapping[str, str], number: Number) -> dict[str, str]:
    """Return the names and TeX texts of a cell, ours and the paper's; `of`: columns `ERRORS` of its row."""
    metric = of["metric"]
    if "+" in metric:
        metric = f"mean{RAW}" if metric.endswith(RAW) else "mean"
    where = "@".join((of["scenario"], of["level"], of["method"], of["joint"], metric))
    return {f"ours@{where}": number.text(), f"published@{where}": number_text(number.published)}


def further_texts(name: str, number: Number) -> dict[str, str]:
    """Return the names and TeX texts of a number of any table, in which a name says table, row and column."""
    texts = {f"cell@{name}": tex_escape(cell_text(number)), f"cellspan@{name}": cell_text(number, "interval")}
    if number.unit == "-":
        texts |= {f"cellshare@{name}": share_text(number.value), f"cellsharespan@{name}": share_span(number)}
    if number.value is not None:
        texts[f"value@{name}"] = f"{number.value:.4f}"
    return texts


def claim_texts(of: Mapping[str, str], number: Number) -> dict[str, str]:
    """Return the names and TeX texts of a claim; `of`: columns `CLAIMS` of its row."""
    value, interval = number.texts()
    texts = {"claimed": number_text(number.published), "found": value, "span": interval}
    if number.unit == "-":
        texts |= {"claimedshare": share_text(number.published), "foundshare": share_text(number.value)}
    texts |= {name: of[name] for name in ("verdict", "cause")}
    return {f"{name}@{of['claim']}": tex_escape(text) for name, text in texts.items()}


def share_text(share: float | None) -> str:
    """Return a share [-] in %, a dash where there is none."""
    return number_text(None if share is None else 100.0 * share, 0)


def share_span(number: Number) -> str:
    """Return the interval of a share [-] in %, nothing where there is none."""
    ends = (None if end is None else 100.0 * end for end in (number.low, number.high))
    return interval_text(*ends, digits=0)


def size_texts(scale: str, rates: Rates, sizes: Scale, fleet: Fleet, train: Recordings) -> dict[str, str]:
    """Return the sizes of a scale as texts: minutes [min], million samples, epochs, seeds, robots."""
    legs = sizes.experiments["left_leg"]
    return {
        "scale": tex_escape(scale),
        "train minutes": f"{train.shards * train.shard_s / MINUTE_S:g}",
        "train samples": f"{train.shards * train.shard_s * rates.data_hz / MILLION:.2g}",
        "test runs": str(sizes.test.shards),
        "test seconds": f"{sizes.test.shard_s:g}",
        "longest seconds": f"{max(sizes.durations_s.values(), default=sizes.test.shard_s):g}",
        "shortest seconds": f"{min(sizes.durations_s.values(), default=sizes.test.shard_s):g}",
        "robots": str(sizes.fleet or len(fleet.robots)),
        "robot test runs": str(sizes.fleet_shards or sizes.test.shards),
        "network runs": str(len(legs.seeds)),
        "epochs": str(legs.epochs),
        **{f"{name} runs": str(len(row.seeds)) for name, row in sizes.experiments.items()},
        **{f"{name} epochs": str(row.epochs) for name, row in sizes.experiments.items()},
    }
