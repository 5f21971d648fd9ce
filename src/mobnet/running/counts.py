"""Snakemake's table of the jobs of a run, with all rules of a kind in one row: hundreds of rules have a job each."""

import logging
from collections.abc import Callable, Mapping

HEAD = "Job stats:"


def by_kind(kinds: Mapping[str, str]) -> Callable[[logging.LogRecord], bool]:
    """Return a filter of a logger that counts the jobs of rules by their kind, rule -> kind; other rules stay."""

    def shorten(record: logging.LogRecord) -> bool:
        counts = getattr(record, "stats", None)  # Snakemake 9: rule -> jobs, and `total`
        if isinstance(counts, Mapping):
            totals: dict[str, int] = {}
            for rule, count in counts.items():
                kind = kinds.get(rule, rule)
                totals[kind] = totals.get(kind, 0) + count
            width = max(map(len, totals))
            record.msg = "\n".join([HEAD, *(f"{kind:<{width}}  {count:>5}" for kind, count in totals.items()), ""])
        return True

    return shorten
