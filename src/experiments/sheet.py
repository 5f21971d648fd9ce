"""`./reproduce sheet`: what the rules read, a row for each set, network, test, table or figure."""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence

from experiments.evaluation.report.cost import overrides
from experiments.plan.plan import make_plan
from experiments.plan.sheets import Row, Sheets
from experiments.running.words import sheet_parser
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.printed import printed

log = logging.getLogger(__name__)


def run(options: Namespace) -> Iterator[str]:
    """Yield the rows of a sheet, all of them if none is named.

    Raises:
        ConfigError: there is no such sheet or row, or a value of the configuration is not accepted.
    """
    plan = make_plan(load_settings(overrides=overrides(options.config)), with_pdf=False)
    sheets = Sheets(plan).all
    if options.name not in sheets:
        raise ConfigError(not_accepted("sheet", options.name, sheets))
    sheet = sheets[options.name]
    names = list(sheet)
    for name in options.rows or names:
        if name not in names:
            raise ConfigError(not_accepted(f"row of {options.name}", name, names))
        yield told(name, sheet[name])


def told(name: str, row: Row) -> str:
    """Return a row as it is printed: its name, then a line for each column that has something."""
    lines = [name]
    for column, names in row.items():
        if names:
            lines.append(f"    {column:<11} {', '.join(map(str, names))}")
    return "\n".join(lines)


def main(words: Sequence[str]) -> int:
    """Print a sheet; return the exit status."""
    options = sheet_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
