"""What a SLURM cluster says of jobs that failed: one line each, from the logs that the executor leaves."""

import re
from collections.abc import Iterator
from pathlib import Path

LOGS = Path(".snakemake") / "slurm_logs"  # of jobs that failed: rule_NAME or group_NAMES / wildcards / NUMBER.log
SHORT = {  # what SLURM says -> what the job had too little of
    "memory limit": "mem_mb=MB",
    "oom_kill": "mem_mb=MB",
    "oom-kill": "mem_mb=MB",
    "TIME LIMIT": "runtime=MINUTES",
}


def failed_jobs(root: Path, since_s: float) -> Iterator[str]:
    """Yield a line for each job whose last attempt failed after a time [s since 1970]: its rule, why, and a remedy."""
    for folder in sorted({path.parent for path in (root / LOGS).rglob("*.log")}):
        last = max(folder.glob("*.log"), key=lambda path: path.stat().st_mtime)
        if last.stat().st_mtime >= since_s:
            name = "/".join(last.relative_to(root / LOGS).parts[:-1])
            yield f"{name}: {reason(last.read_text(encoding='utf-8', errors='replace'))} (log: {last})"


def reason(text: str) -> str:
    """Return why a job failed, from its log: what it had too little of, its own error, or the last line."""
    for words, resource in SHORT.items():
        if words in text:
            return f"ended by SLURM, {words}; accepted: more, by --set-resources RULE:{resource}"
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    told = [match[1] for line in lines if (match := re.search(r"\bERROR (.+)", line))]
    return [*lines[-1:], *told][-1] if lines else "no word of why"
