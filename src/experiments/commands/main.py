"""The commands of `./reproduce`."""

import os
import re
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path

from experiments.commands.clean import clean
from experiments.commands.setup import set_up, site_packages
from experiments.commands.tell import say
from experiments.commands.words import Words, parse
from experiments.running.environment import child_environment, fault_of_place
from experiments.running.one_run import held_folder, only_looks
from mobnet.commands import COMMANDS as LAB
from mobnet.core.errors import CommandError, MobnetError
from mobnet.core.libraries import IN_SITE_PACKAGES, drop_foreign_libraries

MODULES = {  # command -> the module that `python -m` runs, with words that come first
    # For two cores one process more than these: some tests wait for minutes, such as those of a cluster.
    "test": ("pytest", "-n", "3", "--dist", "loadfile", "--no-loadscope-reorder", "--max-worker-restart", "0"),
    "bench": ("benchmarks",),
    "check": ("experiments.check",),
    **{name: ("mobnet", name) for name in LAB},
    "demo": ("experiments.demo",),
    "cost": ("experiments.evaluation.report.cost",),
    "sheet": ("experiments.sheet",),
    "draw": ("experiments.evaluation.report.redraw",),
    "paper": ("experiments.evaluation.report.published_paper",),
    **{name: ("experiments.evaluation.report.snapshot", name) for name in ("verify", "compare", "snapshot")},
}
# Their words are files of the caller, no code of ours.
OUTSIDE = ("check", "demo", *LAB)
# They say themselves what Ctrl-C leaves of them.
LINED = ("cost", "sheet", *LAB)
REPORT = ("--report", "report.html", "--report-after-run")


def main(root: Path, words: Sequence[str]) -> int:
    """Run one command in a project's folder; return its exit status."""
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # `./reproduce` holds it back until here
        return run(root, parse(words))
    except MobnetError as problem:
        say(str(problem))
    except OSError as problem:
        place = problem.filename or root
        say(f"{place}: {problem.strerror}; accepted: a folder with free space, in which you may write and remove")
    except KeyboardInterrupt:
        say("stopped; the same command goes on from here")
        return 130
    return 1


def run(root: Path, words: Words) -> int:
    """Run a command; all but `clean` set the environment up first."""
    if fault := fault_of_place(root):
        raise CommandError(fault)
    if words.command == "clean":
        options = words.options
        return clean(root, everything=options.all, is_dry=options.dry_run, is_sure=options.yes)
    if words.command in LAB:
        LAB[words.command].read(words.extra)
    given = Path.cwd()
    os.chdir(root)
    os.environ.update(environment(root))
    set_up(root, getattr(words.options, "build", None))
    drop_foreign_libraries(site_packages(root) / IN_SITE_PACKAGES)
    if words.command == "setup":
        return 0
    python = str(root / ".venv" / "bin" / "python")
    if words.command in MODULES:
        module = [*MODULES[words.command], *words.extra]
        if words.command == "test":
            os.execv(python, [python, "-m", *module])  # a parent that is stopped would kill it before its summary
        if words.command in LINED:
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        if words.command in OUTSIDE:
            # With open files of the caller, such as those of a shell's <(...).
            return subprocess.run([python, "-P", "-m", *module], cwd=given, close_fds=False, check=False).returncode
        return subprocess.run([python, "-m", *module], check=False).returncode
    asked = [*words.extra, *(REPORT if words.command == "report" else ())]
    if not only_looks(asked):
        with held_folder(root, asked):  # Snakemake, which will hold it, would say the same some seconds later
            pass
    return run_workflow(python, asked)


def environment(root: Path) -> dict[str, str]:
    """Return the variables that every child gets."""
    venv = root / ".venv"
    path = f"{venv / 'bin'}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    return {**child_environment(root), "PATH": path, "VIRTUAL_ENV": str(venv)}


def run_workflow(python: str, words: Sequence[str]) -> int:
    """Become snakemake; Ctrl-C waits until its Snakefile is read, and would be a traceback of imports before."""
    cores = [] if any(re.match(r"(-j|-c|--cores|--jobs)", word) for word in words) else ["--cores", "2"]
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    os.execv(python, [python, "-m", "snakemake", *cores, *words])
