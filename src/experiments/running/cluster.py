"""What a run does for a SLURM cluster: it compiles once for all nodes, and tells of each job that failed in one line.

The executor writes a log for each attempt, in a folder for each job or for all jobs of a group. Such a log begins with
Snakemake's command, which names the job in `--target-jobs`; a block of lines follows for each rule that begins.
"""

import re
import subprocess
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from experiments.running.logs import LOGS as OWN_LOGS

LOGS = Path(".snakemake") / "slurm_logs"  # of jobs that failed: rule_NAME or group_NAMES / wildcards / NUMBER.log
FEW = 10  # jobs of a run, which compile for themselves
ATTEMPTED = re.compile(r"--target-jobs (.+?) --allowed-rules")
BEGUN = re.compile(r"^(?:local)?rule (?P<rule>\w+):\n(?P<told>(?: {4}.*\n)*)", re.MULTILINE)
FAILED = re.compile(r"^Error in rule (?P<rule>\w+):?.*\n(?P<told>(?: {4}.*\n)*)", re.MULTILINE)
FINISHED = re.compile(r"^Finished jobid: (\d+)", re.MULTILINE)


class Limit(NamedTuple):
    """A resource of a rule, how SLURM ends a job that needs more of it, and its unit."""

    resource: str
    ended: str
    unit: str


MEMORY = Limit("mem_mb", "ended by SLURM above its", "MB")
TIME = Limit("runtime", "ended by SLURM after its", "min")
LIMITS = {"memory limit": MEMORY, "oom_kill": MEMORY, "oom-kill": MEMORY, "TIME LIMIT": TIME}  # by SLURM's words
LIMITED = tuple(dict.fromkeys(limit.resource for limit in LIMITS.values()))
Had = Mapping[str, Mapping[str, int]]  # a job's own log -> resource -> what the job asked for


def warm_cache(python: str, root: Path, jobs: int) -> None:
    """Compile here what jobs run, so that the nodes, if they have this processor, find it in the cache.

    A run of few jobs leaves it to them. A fault is told by the process that compiles, and by the jobs if they meet it.
    """
    if jobs <= FEW:
        return
    subprocess.run([python, "workflow/scripts/warm.py"], cwd=root, check=False)


def failed_jobs(root: Path, since_s: float, had: Had) -> Iterator[str]:
    """Yield a line for each job whose last attempt failed after a time [s since 1970]: its name, why, and a remedy."""
    for path, text in last_attempts(root, since_s):
        block = failed_in(text)
        log = told(block, "log") if block else ""
        if log and went_on(root / log, path):
            continue
        rule, *place = [block["rule"]] if block else placed(path.relative_to(root / LOGS).parts)
        kind, name = named(log) if log else (rule, *place, "")[:2]
        yield f"{f'{kind} ({name})' if name else kind}: {reason(text, kind, had.get(log, {}))} (log: {path})"


def last_attempts(root: Path, since_s: float) -> list[tuple[Path, str]]:
    """Return the log of the last attempt of each job that failed after a time, and its text."""
    paths = [path for path in (root / LOGS).rglob("*.log") if path.stat().st_mtime >= since_s]
    last: dict[str, tuple[Path, str]] = {}
    for path in sorted(paths, key=lambda path: path.stat().st_mtime):
        text = path.read_text(encoding="utf-8", errors="replace")
        job = ATTEMPTED.search(text)
        last[job[1] if job else str(path.parent)] = path, text
    return sorted(last.values())


def failed_in(text: str) -> re.Match[str] | None:
    """Return the block of the rule that Snakemake says has failed, or of the last one that began and did not end."""
    finished = FINISHED.findall(text)
    begun = [match for match in BEGUN.finditer(text) if told(match, "jobid") not in finished]
    return next(FAILED.finditer(text), begun[-1] if begun else None)


def went_on(job_log: Path, log: Path) -> bool:
    """Return whether a later attempt wrote to a job's own log; it succeeded, as the executor removed its log."""
    return job_log.exists() and job_log.stat().st_mtime > log.stat().st_mtime


def named(log: str) -> tuple[str, str]:
    """Return the kind of a job and its name, from its own log: `logs/train/robot_1/NAME.log`, `logs/table_05.log`."""
    kind, _, name = log.removesuffix(".log").rpartition(f"/{OWN_LOGS}/")[2].partition("/")
    return kind, name


def placed(place: tuple[str, ...]) -> tuple[str, str]:
    """Return the rule and the wildcards that the place of a log names: the job ended before Snakemake began."""
    return place[0].partition("_")[2], "/".join(place[1:-1]).strip("_")


def told(block: re.Match[str], key: str) -> str:
    """Return the first word of a key in a block of Snakemake's log, or nothing."""
    match = re.search(rf"^ {{4}}{key}: (\S+)", block["told"], re.MULTILINE)
    return match[1] if match else ""


def reason(text: str, rule: str, had: Mapping[str, int]) -> str:
    """Return why a job failed, from its log: what it had too little of, its own error, or the last line."""
    for words, limit in LIMITS.items():
        if words in text:
            return too_little(limit, rule, had.get(limit.resource))
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [match[1] for line in lines if (match := re.search(r"\bERROR (.+)", line))]
    return [*lines[-1:], *errors][-1] if lines else "no word of why"


def too_little(limit: Limit, rule: str, had: int | None) -> str:
    """Return what a job had too little of, and the option that gives it twice as much."""
    amount, more = (f"{had} {limit.unit}", str(2 * had)) if had else ("limit", limit.unit.upper())
    return f"{limit.ended} {amount}; give it more with --set-resources {rule}:{limit.resource}={more}"
