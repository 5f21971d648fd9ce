"""Numbers of the paper's prose as TeX macros, so that a sentence cannot disagree with its table."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.number.number import Number, interval_text, number_text
from experiments.evaluation.number.rows import read_numbers
from experiments.evaluation.report.captions import MACROS, captions_tex, fill_captions, named
from experiments.evaluation.report.main_tables import bound_of, cell_text, cells_of, main_tables
from experiments.evaluation.tables.layout import tex_escape
from experiments.intervals.bounds import range_text
from experiments.settings.scales import Scale
from experiments.settings.table_columns import CLAIMED, ERRORS
from experiments.settings.tables import MainTables
from mobnet.core.files import read_text, write_text
from mobnet.core.rows import read_texts
from mobnet.settings.data import Recordings
from mobnet.settings.plant import Rates
from mobnet.settings.surrogate import Fleet

LOOKUP = r"""% Written by experiments.evaluation.report.numbers; do not edit.
\newcommand{\lookup}[1]{\ifcsname #1\endcsname\csname #1\endcsname\else\errmessage{numbers.tex has no #1}\fi}
"""
GUARDS = r"""\newcommand{\turned}{\textsuperscript{$\dagger$}}
\makeatletter
\DeclareRobustCommand{\holds}[2]{\begingroup\edef\mobnet@now{\csname verdict@#1\endcsname}\let\mobnet@mark\turned
  \@for\mobnet@one:=#2\do{\ifx\mobnet@one\mobnet@now\let\mobnet@mark\relax\fi}\mobnet@mark\endgroup}
\DeclareRobustCommand{\below}[2]{\begingroup\let\mobnet@mark\turned
  \ifcsname value@#1\endcsname\ifcsname value@#2\endcsname
  \ifdim\csname value@#1\endcsname pt<\csname value@#2\endcsname pt\let\mobnet@mark\relax\fi\fi\fi
  \mobnet@mark\endgroup}
\makeatother
"""
ABSENT = r"--\turned"  # in place of a number that no table has
CLAIMS = "claims"  # table of them, and of their counts as claims_summary
REFUTED = ("not reproduced", "sign only")  # verdicts: in sign, or in size alone
MINUTE_S = 60.0
MILLION = 1e6


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
    captions_dir: Path,
    out: Path,
) -> None:
    r"""Write what the paper's text takes: macros of numbers, captions.tex beside them, and the tables of the main text.

    \ourcell{scenario}{level}{method}{joint}{metric} and \publishedcell give a cell of a table of errors (metric: `mean`
    if it is the mean of some), \ours{level}{method}{joint} and \published a cell of Table 5. \cell{table@...} gives a
    number of any other table, by its columns before the number, \cellspan its interval, \cellshare and \cellsharespan
    those of a share [-] in %. \claimed{claim} gives the paper's number of a claim, \found and \foundspan ours and its
    interval, \claimedshare and \foundshare both in %, \claimedrange and \signrange the
    claimed ranges of size and sign, \verdict and \cause the judgement. \scored{score}{outcome} gives
    how many statements of a score have a verdict or another outcome of `claims_summary`, or are `refuted` in size or
    sign, \firsts how many by their first claim alone, \counted how many claims; \size{name} gives sizes of the scale.

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
        captions_dir: folder of the captions with their numbers, for pages.
        out: file of the macros.
    """
    values = {f"size@{name}": text for name, text in size_texts(scale, rates, sizes, fleet, train).items()}
    values |= texts_of(table_csvs, further_csvs, claims_csv, summary_csv)
    write_text(out, numbers_tex(values))
    write_text(out.with_name("captions.tex"), captions_tex(captions))
    fill_captions(captions, values, captions_dir)
    main_tables(compared, sources, out.with_name("legs.csv"))


def numbers_tex(values: Mapping[str, str], absent: Iterable[str] = ()) -> str:
    """Return TeX that defines the macros, and what they look up: name -> plain text.

    In place of each of the `absent` names a text has a dash with a dagger.
    """
    # A TeX line defines one name, which may hold any character, as a text; what TeX compares stays a plain number.
    escaped = {name: text if name.startswith("value@") else tex_escape(text) for name, text in values.items()}
    escaped |= dict.fromkeys(absent, ABSENT)
    lines = (rf"\expandafter\def\csname {name}\endcsname{{{text}}}" + "\n" for name, text in escaped.items())
    return LOOKUP + macros_tex() + GUARDS + "".join(lines)


def macros_tex() -> str:
    """Return TeX that defines the macros which look texts up."""
    lines: list[str] = []
    for macro, pattern in MACROS.items():
        count = pattern.count("#")
        looked_up = named(pattern, [f"#{k}" for k in range(1, count + 1)])
        lines.append(rf"\newcommand{{\{macro}}}[{count}]{{\lookup{{{looked_up}}}}}")
    return "\n".join(lines) + "\n"


def texts_of(
    table_csvs: Sequence[Path], further_csvs: Sequence[Path], claims_csv: Path, summary_csv: Path
) -> dict[str, str]:
    """Return name -> plain text of all numbers of tables of errors, of other tables, of claims and of their counts."""
    values: dict[str, str] = {}
    for path in table_csvs:
        for of, number in read_numbers(path):
            values |= cell_texts(of, number)
    for path in further_csvs:
        values |= table_texts(path)
    for of, number in read_numbers(claims_csv):
        values |= claim_texts(of, number)
    for row in read_texts(summary_csv, CLAIMED):
        for name, of in (("scored", "statements"), ("firsts", "firsts"), ("counted", "claims")):
            values[f"{name}@{row['score']}@{row['outcome']}"] = row[of]
    for score in ("paper", "ours"):
        values[f"scored@{score}@refuted"] = str(sum(int(values[f"scored@{score}@{verdict}"]) for verdict in REFUTED))
    return values


def table_texts(path: Path) -> dict[str, str]:
    """Return name -> plain text of all numbers of any table with a column `value`."""
    texts: dict[str, str] = {}
    cells = cells_of(path)
    for name, number in cells.items():
        texts |= further_texts(name, number, is_bound=bool(bound_of(cells, name).value))
    return texts


def texts_in(folder: Path) -> dict[str, str]:
    """Return name -> plain text of all numbers of the published tables in a folder, as `texts_of`."""
    errors: list[Path] = []
    further: list[Path] = []
    for path in sorted(folder.glob("*.csv")):
        columns = read_text(path).partition("\n")[0].split(",")
        if path.stem != CLAIMS and "value" in columns:
            further.append(path)
            if set(ERRORS) <= set(columns):
                errors.append(path)
    return texts_of(errors, further, folder / f"{CLAIMS}.csv", folder / f"{CLAIMS}_summary.csv")


def cell_texts(of: Mapping[str, str], number: Number) -> dict[str, str]:
    """Return the names and texts of a cell, ours and the paper's; `of`: columns `ERRORS` of its row."""
    metric = of["metric"]
    if "+" in metric:
        metric = f"mean{RAW}" if metric.endswith(RAW) else "mean"
    where = "@".join((of["scenario"], of["level"], of["method"], of["joint"], metric))
    return {f"ours@{where}": number.text(), f"published@{where}": number_text(number.published)}


def further_texts(name: str, number: Number, is_bound: bool = False) -> dict[str, str]:
    """Return the names and texts of a number of any table, in which a name says table, row and column.

    A lower bound is marked as one.
    """
    texts = {
        f"cell@{name}": f">{cell_text(number)}" if is_bound else cell_text(number),
        f"cellspan@{name}": cell_text(number, "interval"),
    }
    if number.unit == "-":
        texts |= {f"cellshare@{name}": share_text(number.value), f"cellsharespan@{name}": share_span(number)}
    if number.value is not None:
        texts[f"value@{name}"] = f"{number.value:.4f}"
    return texts


def claim_texts(of: Mapping[str, str], number: Number) -> dict[str, str]:
    """Return the names and texts of a claim; `of`: columns `CLAIMS` of its row."""
    value, interval = number.texts()
    texts = {"claimed": number_text(number.published), "found": value, "span": interval}
    if number.unit == "-":
        texts |= {"claimedshare": share_text(number.published), "foundshare": share_text(number.value)}
    for name, ends in (("claimedrange", ("from", "to")), ("signrange", ("sign_from", "sign_to"))):
        low, high = (float(of[end]) if of[end] else None for end in ends)
        texts[name] = range_text((low, high))
    texts |= {name: of[name] for name in ("verdict", "cause")}
    return {f"{name}@{of['claim']}": text for name, text in texts.items()}


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
        "scale": scale,
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
