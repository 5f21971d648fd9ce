"""Numbers of the paper's prose as TeX macros, so that a sentence cannot disagree with its table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.number.rows import Cell, read_rows
from mobnet.evaluation.tables.claims import VERDICTS, Verdict, ours_text
from mobnet.evaluation.tables.layout import number, tex_escape

LOOKUP = r"""% Written by mobnet.evaluation.report.numbers; do not edit.
\newcommand{\lookup}[1]{\ifcsname #1\endcsname\csname #1\endcsname\else\errmessage{numbers.tex has no #1}\fi}
\newcommand{\ourcell}[5]{\lookup{ours@#1@#2@#3@#4@#5}}
\newcommand{\publishedcell}[5]{\lookup{published@#1@#2@#3@#4@#5}}
\newcommand{\ours}[3]{\ourcell{forward_walk}{#1}{#2}{#3}{rmse}}
\newcommand{\published}[3]{\publishedcell{forward_walk}{#1}{#2}{#3}{rmse}}
\newcommand{\claimed}[1]{\lookup{claimed@#1}}
\newcommand{\found}[1]{\lookup{found@#1}}
\newcommand{\foundspan}[1]{\lookup{span@#1}}
\newcommand{\verdict}[1]{\lookup{verdict@#1}}
\newcommand{\cause}[1]{\lookup{cause@#1}}
\newcommand{\size}[1]{\lookup{size@#1}}
"""
MINUTE_S = 60.0
MILLION = 1e6


def numbers(config: Mapping[str, Any], tables: Iterable[Path], claims_csv: Path, out_tex: Path) -> None:
    r"""Write the macros that the paper's text uses.

    \ourcell{scenario}{level}{method}{joint}{metric} and \publishedcell give a cell of any table (metric: `mean` where
    it is over some), \ours{level}{method}{joint} and \published one of Table 5; \claimed{claim}, \found, \foundspan
    (its interval), \verdict and \cause what became of a claim; \size{name} the scale's sizes and how many claims hold.

    Args:
        config: resolved configuration; its sizes become \size.
        tables: cells of Tables 5, 6, 7, 10 and 11.
        claims_csv: judged claims.
        out_tex: TeX file to \input before the text.

    Raises:
        DataError: a file is missing or damaged.
    """
    values = {f"size@{name}": text for name, text in size_texts(config).items()}
    for path in tables:
        for cell in read_rows(path, Cell):
            values |= cell_texts(cell)
    verdicts = read_rows(claims_csv, Verdict)
    for row in verdicts:
        values |= claim_texts(row)
    values |= {f"size@{kind}": str(sum(row.verdict == kind for row in verdicts)) for kind in VERDICTS}
    values["size@claims"] = str(len(verdicts))
    write_text(out_tex, LOOKUP + "".join(map(tex_definition, values.items())))


def cell_texts(cell: Cell) -> dict[str, str]:
    """Return the names and TeX texts of a cell, ours and the paper's."""
    metric = "mean" if "+" in cell.metric else cell.metric
    where = "@".join((cell.scenario, cell.level, cell.method, cell.joint, metric))
    return {f"ours@{where}": number(cell.value), f"published@{where}": number(cell.published)}


def claim_texts(row: Verdict) -> dict[str, str]:
    """Return the names and TeX texts of a claim."""
    value, interval = ours_text(row)
    texts = {"claimed": number(row.published), "found": value, "span": interval, "verdict": row.verdict}
    return {f"{name}@{row.claim}": tex_escape(text) for name, text in (texts | {"cause": row.cause}).items()}


def tex_definition(item: tuple[str, str]) -> str:
    """Return the TeX line that defines one name, which may hold any character, as a text."""
    name, text = item
    return rf"\expandafter\def\csname {name}\endcsname{{{text}}}" + "\n"


def size_texts(config: Mapping[str, Any]) -> dict[str, str]:
    """Return the sizes of the chosen scale as texts: minutes [min], million samples, epochs, seeds."""
    sizes = config["sizes"]
    train, test, legs = sizes["train"]["walk"], sizes["test"], sizes["experiments"]["left_leg"]
    return {
        "scale": tex_escape(config["scale"]),
        "train minutes": f"{train['shards'] * train['shard_s'] / MINUTE_S:g}",
        "train samples": f"{train['shards'] * train['shard_s'] * config['rates']['data_hz'] / MILLION:.2g}",
        "test runs": str(test["shards"]),
        "test seconds": f"{test['shard_s']:g}",
        "network runs": str(len(legs["seeds"])),
        "epochs": str(legs["epochs"]),
        **{f"{name} runs": str(len(row["seeds"])) for name, row in sizes["experiments"].items()},
        **{f"{name} epochs": str(row["epochs"]) for name, row in sizes["experiments"].items()},
    }
