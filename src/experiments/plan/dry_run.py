"""The jobs that a run of the workflow would start, as a dry run of Snakemake tells them."""

import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Self

from experiments.running.logs import account_name
from mobnet.core.code import ROOT
from mobnet.core.errors import ConfigError

JOB = re.compile(r"^ *(?:local)?rule (?P<rule>\w+):\n(?P<told>(?: {4,}\w+: .*\n)*)", re.MULTILINE)


@dataclass(frozen=True)
class PlannedJob:
    """A job that a run would start.

    Attributes:
        rule: the rule of the job.
        name: of its account; the name of its rule where it has no log.
        wildcards: of the rule.
        outputs: files and folders that it makes.
        resources: what it asks for.
        inputs: files and folders that it reads.
        priority: with which it starts before others.
    """

    rule: str
    name: str
    wildcards: Mapping[str, str]
    outputs: tuple[str, ...]
    resources: Mapping[str, str]
    inputs: tuple[str, ...] = ()
    priority: int = 0

    @classmethod
    def of(cls, job: Any) -> Self:
        """Return a job of Snakemake, within the process that runs it."""
        log = next(iter(job.log), None)
        return cls(
            rule=job.rule.name,
            name=account_name(Path(log)) if log else job.rule.name,
            wildcards=dict(job.wildcards_dict),
            outputs=tuple(map(str, job.output)) or ("",),
            resources={name: str(value) for name, value in job.resources.items()},
            inputs=tuple(map(str, job.input)),
            priority=job.priority,
        )

    @property
    def w(self) -> SimpleNamespace:
        """The wildcards as the functions of rules take them."""
        return SimpleNamespace(**self.wildcards)


def dry_run(targets: Sequence[str], config: Sequence[str] = (), *, from_nothing: bool = False) -> list[PlannedJob]:
    """Return the jobs that a run of targets would start now, or would start if none of its files were there.

    Args:
        targets: rules and files.
        config: words KEY=VALUE of the configuration.
        from_nothing: whether files that are there are taken as missing.

    Raises:
        ConfigError: a target or a value of the configuration is not accepted.
    """
    words = [sys.executable, "-m", "snakemake", "-n", "--quiet", "host"]
    words += ["--forceall"] if from_nothing else []
    words += ["--config", *config] if config else []
    words += ["--", *targets]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    printed = done.stdout + done.stderr
    if done.returncode:
        raise ConfigError(next((line for line in reversed(printed.splitlines()) if line.strip()), "snakemake failed"))
    return [_job(match["rule"], match["told"]) for match in JOB.finditer(printed)]


def _job(rule: str, text: str) -> PlannedJob:
    """Return a job from the lines that tell of it, `key: value`."""
    values: dict[str, str] = {}
    for line in text.splitlines():
        key, _, value = line.strip().partition(": ")
        values[key] = value
    return PlannedJob(
        rule=rule,
        name=account_name(Path(values["log"])) if "log" in values else rule,
        wildcards=_pairs(values.get("wildcards", "")),
        outputs=tuple(values.get("output", "").split(", ")),
        resources=_pairs(values.get("resources", "")),
        inputs=tuple(values.get("input", "").split(", ")),
        priority=int(values.get("priority", 0)),
    )


def _pairs(text: str) -> dict[str, str]:
    """Return the pairs of `one=1, other=2`."""
    pairs: dict[str, str] = {}
    for pair in filter(None, text.split(", ")):
        name, _, value = pair.partition("=")
        pairs[name] = value
    return pairs
