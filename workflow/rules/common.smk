# What the rules share: the checked configuration, the plan that follows from it, and what each job depends on.

import os
import shlex
import sys
import time
from importlib.metadata import version

from snakemake.cli import get_argument_parser
from snakemake.logging import logger

from experiments.running.interrupts import Interrupts
from experiments.running.terminal import shown_by

# Ctrl-C is answered from here on: all that is imported below takes a second.
SHOWN_BY = shown_by(workflow.logger_manager.get_log_handlers())
INTERRUPTS = Interrupts(SHOWN_BY) if workflow.is_main_process else None

from experiments.evaluation.measure.estimates.scores import measure_problems
from experiments.evaluation.report.paper import missing_packages
from experiments.jobs.method_problems import method_problems
from experiments.plan.dry_run import PlannedJob
from experiments.plan.files import made_by_jobs
from experiments.plan.limits import limits
from experiments.plan.plan import (
    auto_precision,
    make_plan,
    record_precision,
    record_stacks,
    with_precision,
    with_stacks,
)
from experiments.plan.products import shown as report_of
from experiments.plan.room import Sizes, check_room, share_at_once
from experiments.plan.schedule import TimedJob
from experiments.running.begun import BEGUN as BEGUN_LIST
from experiments.running.begun import lost, record_begun, record_end
from experiments.running.one_run import hold_folder, only_looks
from experiments.plan.targets import faults_of_words, made_line
from experiments.running.progress import in_time
from experiments.running.words import one_of, refuse_twice, scale_of_targets
from experiments.settings.checks.claims import text_problems
from experiments.running.cluster import LIMITED, failed_jobs, warm_cache
from experiments.running.environment import quieten, sweep_project
from experiments.running.processes import PREFIX, end_orphans, follow_trainings
from experiments.settings.load import load_settings
from mobnet.core.code import UNKNOWN, code_hash, commit
from mobnet.core.detections import FILES
from mobnet.core.errors import MobnetError
from mobnet.core.files import check_room as check_folder
from mobnet.core.machine import gpus_seen
from mobnet.core.printed import end_where_full, watch_output

ROOT = Path(workflow.current_basedir).parent.parent
STARTED_S = time.time()

quieten(ROOT)
PYTHON = sys.executable
sys.executable = shlex.quote(PYTHON)  # Snakemake writes it into shell commands as it is
shell.prefix(PREFIX)


def is_main():
    """Return whether the words of the call are meant for these rules: not in a job, nor in a module of others."""
    return workflow.is_main_process and Path(workflow.main_snakefile).parent == ROOT


def known_words():
    """Return the words of the call as Snakemake takes them apart."""
    refuse_twice(sys.argv[1:])
    watch_output()
    known, _ = get_argument_parser().parse_known_args(sys.argv[1:])
    if known.dryrun:
        end_where_full(logger.handlers)  # it is for what it prints
    return known


def what_other_packages_know(settings):
    """Yield what kinds of methods, modules of measures and the paper's text do not accept."""
    yield from method_problems(settings)
    yield from measure_problems(settings)
    yield from text_problems(settings, ROOT / "paper" / "main.tex")


# Jobs that use a GPU wait for those of this machine; on a cluster they ask for one by --set-resources train:gpu=1.
GPUS = gpus_seen(version("torch"), os.environ) if workflow.nodes is None else 0

try:
    if is_main():
        for name in (".snakemake", ".cache"):  # Snakemake and packages write there
            check_folder(ROOT / name)
        if not only_looks(sys.argv[1:]):
            hold_folder(ROOT, sys.argv[1:])
            end_orphans(ROOT)
    WORDS = known_words() if is_main() else None
    TARGETS = [str(target) for target in WORDS.targets] if WORDS else []
    if scale := scale_of_targets(TARGETS, config.get("scale")):
        config["scale"] = scale
    SETTINGS = load_settings(ROOT / "configs", config, what_other_packages_know)
    PRECISION = auto_precision(SETTINGS, Path("results") / SETTINGS.scale, is_dry=bool(WORDS and WORDS.dryrun))
    SETTINGS = with_precision(SETTINGS, PRECISION)
    SETTINGS = with_stacks(SETTINGS, Path("results") / SETTINGS.scale, GPUS)
    PLAN = make_plan(SETTINGS, with_pdf=not missing_packages())
    LIMITS = limits(PLAN)
except MobnetError as error:
    sys.exit(str(error))

JOBS = PLAN.jobs
SIZES = Sizes(JOBS)
STATE = PLAN.folders.results / BEGUN_LIST
LOST = lost(STATE) if is_main() else []
config["scale"] = SETTINGS.scale  # the report names it
if GPUS and "gpu" not in workflow.global_resources:
    workflow.register_resource("gpu", GPUS)


pathvars:
    results=str(PLAN.folders.results),
    logs=str(PLAN.folders.results / "logs"),
    tables=str(PLAN.folders.tables),
    figures=str(PLAN.folders.figures),


wildcard_constraints:
    robot=one_of(PLAN.robots),
    scenario=one_of(SETTINGS.scenarios),
    level=one_of(PLAN.levels),
    motion=one_of(SETTINGS.motions),
    limb=one_of(SETTINGS.networks),
    method=one_of(PLAN.methods),
    seed=r"\d+",


onstart:
    INTERRUPTS.jobs_begin(are_local=workflow.local_exec)
    try:
        sweep_project(ROOT)  # no other run goes on here
        record_precision(PLAN.folders.results, PRECISION)
        record_stacks(SETTINGS, PLAN.folders.results)
        waiting = list(workflow.dag.needrun_jobs())
        record_begun(STATE, PLAN.kept(str(output) for job in waiting for output in job.output))
        seconds = tell_prices(waiting)
        check_room(waiting, room_share(waiting, seconds))
        if commit() == UNKNOWN:
            sys.stderr.write(
                f"{ROOT}: git knows no commit here, so results will not say which code made them (commit: unknown)\n"
            )
        if not workflow.local_exec:
            warm_cache(PYTHON, ROOT, jobs=len(waiting))
        if any(job.rule.name.startswith("train") for job in waiting):
            follow_trainings(PYTHON, PLAN.folders.results, Path(".cache") / "wandb_live.log")
    except MobnetError as error:
        sys.exit(str(error))
    if workflow.local_exec:
        # The number of cores limits the rate. Snakemake looks at all ready jobs in every timespan, once for each job
        # that has ended: half of a core after 100 jobs (its pull request 3744).
        workflow.scheduler.job_rate_limiter = None


onsuccess:
    INTERRUPTS.jobs_ended()
    record_end(STATE)
    sys.stderr.write(
        f"{made_line(TARGETS, list(workflow.rules), PLAN.folders)}, in {in_time(time.time() - STARTED_S)}\n"
    )


onerror:
    if not workflow.local_exec:
        had = {
            str(job.log): {name: job.resources.get(name) for name in LIMITED} for job in workflow.dag.needrun_jobs()
        }
        for line in failed_jobs(ROOT, STARTED_S, had):
            sys.stderr.write(f"{line}\n")


def needed(job, *names):
    """Return a function of wildcards: what other jobs make of the files behind arguments that a job gets."""

    def read(w):
        # Snakemake has begun to ask what is to be made, and has not yet decided what of it runs.
        workflow.dag.forcefiles.update(LOST)
        return made_by_jobs([job(w).get(name) for name in names])

    return read


def gone(names):
    """Return what a run has made and somebody has removed: Snakemake misses what it is asked for, not what lies between."""
    return [name for name in names if PLAN.folders.manifest.exists() and not Path(name).exists()]


def code(script, further=lambda w: []):
    """Return what a job reruns on besides its files and arguments: the code of its script, with all that it uses.

    What a script imports by a name that wildcards give, `further` says.
    """
    return lambda w: code_hash(ROOT / "workflow" / "scripts" / f"{script}.py", *further(w))


def shown(figure):
    """Mark the picture of a figure for the report."""

    def labels(w):
        return {"file": w.figure, "shows": PLAN.title(w.figure)}

    return report(figure, caption=ROOT / "workflow" / "report" / "figure.rst", category="Figures", labels=labels)


def flagged(name):
    """Mark an output of a product whose rule makes nothing else, as a folder or a file with its caption."""
    output = name if Path(name).suffix else directory(name)
    how = report_of(name)
    if how is None:
        return output
    labels = {"file": Path(name).stem, "shows": how.title}
    # Results lie in the working folder, also captions with numbers, which are there once a report is made.
    caption = how.caption and PLAN.folders.caption(how.caption)
    if caption:
        caption = (ROOT if caption == how.caption else Path.cwd()) / caption
    return report(output, caption=caption, category=how.category, labels=labels)


def tell_prices(jobs):
    """Tell what shows the run how long its jobs will take; return it, by their numbers [s]."""
    # This import takes a second, which the process of a job does not need.
    from experiments.evaluation.report.cost import expected_s

    seconds = expected_s(PLAN, {job.jobid: PlannedJob.of(job) for job in jobs})
    for handler in SHOWN_BY:
        handler.expect(seconds, waiting=len(jobs), made=len(workflow.dag.jobs) - len(jobs))
    return seconds


def room_share(jobs, seconds):
    """Return the share of what some jobs write that is there at once."""
    if SETTINGS.keep == "all":
        return 1.0
    return share_at_once(
        [TimedJob(PlannedJob.of(job), seconds.get(job.jobid, 0.0)) for job in jobs], workflow.cores or 1
    )


def let_go(output):
    """Mark a set that is removed when nothing needs it any more, if the configuration says so."""
    return output if SETTINGS.keep == "all" else temp(output)


def let_go_early():
    """Let jobs come first that read sets, and those last that make recordings: so little is there at once."""
    first = {"collect": 0, "motion": 10, "observe": 30, "estimate": 30}
    if SETTINGS.keep != "all":
        for each in workflow.rules:
            each.priority = first.get(each.name, 20)
