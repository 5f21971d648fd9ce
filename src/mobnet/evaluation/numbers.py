"""Numbers of the paper's prose as TeX macros, so that a sentence cannot disagree with its table."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.claims import Verdict
from mobnet.evaluation.markup import number, tex_escape
from mobnet.evaluation.rows import Cell, read_rows

LOOKUP = r"""% Written by mobnet.evaluation.numbers; do not edit.
\newcommand{\lookup}[1]{\ifcsname #1\endcsname\csname #1\endcsname\else\errmessage{numbers.tex has no #1}\fi}
\newcommand{\ours}[3]{\lookup{ours@#1@#2@#3}}
\newcommand{\published}[3]{\lookup{published@#1@#2@#3}}
\newcommand{\claimed}[1]{\lookup{claimed@#1}}
\newcommand{\found}[1]{\lookup{found@#1}}
\newcommand{\verdict}[1]{\lookup{verdict@#1}}
\newcommand{\size}[1]{\lookup{size@#1}}
"""
MINUTE_S = 60.0
MILLION = 1e6


def numbers(config: Mapping[str, Any], table_csv: Path, claims_csv: Path, out_tex: Path) -> None:
    r"""Write the macros \ours{level}{method}{joint}, \published, \claimed{claim}, \found, \verdict and \size{name}.

    Args:
        config: resolved configuration; its sizes become \size.
        table_csv: cells of Table 5, values in [N m].
        claims_csv: judged claims.
        out_tex: TeX file to \input before the text.

    Raises:
        DataError: a file is missing or damaged.
    """
    values = {f"size@{name}": text for name, text in size_texts(config).items()}
    for cell in read_rows(table_csv, Cell):
        where = f"{cell.level}@{cell.method}@{cell.joint}"
        values |= {f"ours@{where}": number(cell.value), f"published@{where}": number(cell.published)}
    verdicts = read_rows(claims_csv, Verdict)
    for row in verdicts:
        values |= {f"claimed@{row.claim}": number(row.published), f"found@{row.claim}": number(row.value)}
        values[f"verdict@{row.claim}"] = tex_escape(row.verdict)
    for kind in ("reproduced", "direction only", "not reproduced"):
        values[f"size@{kind}"] = str(sum(row.verdict == kind for row in verdicts))
    values["size@claims"] = str(len(verdicts))
    write_text(out_tex, LOOKUP + "".join(map(tex_definition, values.items())))


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
