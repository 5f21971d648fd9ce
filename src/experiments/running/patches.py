"""Everything that this project changes inside other packages, each for the version that `VERSIONS` names.

With another version a test fails: read the code of each patch's place again, and drop the patch if it may go.
"""

import logging
import shlex
import sys
from collections.abc import Callable, Mapping
from typing import Any, TextIO, cast

import yaml

VERSIONS = {"snakemake": "9.27.1", "yte": "1.9.4"}
USE_CODE = "__use_yte__"
HEAD = "Job stats:"


def refuse_code() -> None:
    """Read Snakemake's profiles and `--configfile` as plain values; the reader of yte runs code that stands in them."""
    import yte

    yte.process_yaml = plain_yaml


def plain_yaml(stream: TextIO, **_: object) -> object:
    """Read a YAML file as plain values; `__use_yte__` and tags of Python end the run before anything of it runs."""
    try:
        values = yaml.safe_load(stream)  # by Python, in which deep nesting is an error and not the end of the process
    except (yaml.YAMLError, RecursionError) as error:
        sys.exit(f"{stream.name}: {' '.join(str(error).split())}; accepted: plain YAML")
    if isinstance(values, dict) and USE_CODE in values:
        sys.exit(f"{stream.name}: key {USE_CODE!r} is not accepted; accepted: plain YAML, without code")
    return cast("object", values)


def quote_python() -> None:
    """Quote the path of Python, which Snakemake writes into shell commands as it is."""
    sys.executable = shlex.quote(sys.executable)


def python() -> str:
    """Return the path of Python, which Snakemake's process has quoted."""
    return shlex.split(sys.executable)[0]


def drop_rate_limit(workflow: Any) -> None:
    """Start jobs as soon as a core is free.

    With a rate limit Snakemake looks at all ready jobs in every timespan, once for each job that ended: half of a core
    after 100 jobs. Where jobs run here, the number of cores limits the rate.
    """
    workflow.scheduler.job_rate_limiter = None


def set_resources_by_kind(workflow: Any, kinds: Mapping[str, str]) -> None:
    """Let `--set-resources train:mem_mb=8000` mean every rule of a kind, of rule -> kind."""
    from snakemake.resources import Resources

    asked = workflow.resource_settings.overwrite_resources
    for rule, kind in kinds.items():
        if kind in asked:
            asked[rule] = Resources({**asked[kind], **asked.get(rule, {})})


def by_kind(kinds: Mapping[str, str]) -> Callable[[logging.LogRecord], bool]:
    """Return a log filter that counts jobs in Snakemake's table by kind, not by rule; `kinds` is rule -> kind."""

    def shorten(record: logging.LogRecord) -> bool:
        counts = getattr(record, "stats", None)  # rule -> jobs, and `total`
        if isinstance(counts, Mapping):
            totals: dict[str, int] = {}
            for rule, count in counts.items():
                kind = kinds.get(rule, rule)
                totals[kind] = totals.get(kind, 0) + count
            width = max(map(len, totals))
            record.msg = "\n".join([HEAD, *(f"{kind:<{width}}  {count:>5}" for kind, count in totals.items()), ""])
        return True

    return shorten
