"""What the rules share: the checked configuration, the plan that follows from it, and what each rule depends on."""

import os
import sys
import time
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from snakemake.logging import logger as snakemake_logger
from snakemake.settings.enums import RerunTrigger

from experiments.evaluation.measure.estimates.scores import measure_problems
from experiments.evaluation.report.paper import missing_packages
from experiments.jobs.method_problems import method_problems
from experiments.plan.disk import check_places, check_space
from experiments.plan.places import check_scale
from experiments.plan.plan import make_plan
from experiments.plan.precision import record_precision, with_precision
from experiments.plan.products import shown
from experiments.plan.plan import Stamped
from experiments.settings.checks.claims import text_problems
from experiments.running.cluster import LIMITED, failed_jobs, warm_cache
from experiments.running.environment import quieten
from experiments.running.follow import follow_trainings
from experiments.running.patches import by_kind, drop_rate_limit, quote_python, set_resources_by_kind
from experiments.running.run import is_stopped, refuse_configfiles, start_jobs
from experiments.settings.load import load_settings
from mobnet.core.errors import MobnetError, refuse_lines
from mobnet.core.machine import gpus_seen
from mobnet.core.lock import job_prefix

ROOT, STARTED_S = Path(workflow.basedir), time.time()
quieten(ROOT)
shell.prefix(job_prefix(ROOT))


def what_other_packages_know(settings):
    """Yield what kinds of methods, modules of measures and the paper's text do not accept."""
    yield from method_problems(settings)
    yield from measure_problems(settings)
    yield from text_problems(settings, ROOT / "paper" / "main.tex")


quote_python()

try:
    refuse_configfiles(workflow.overwrite_configfiles)
    SETTINGS = load_settings(ROOT / "configs", config, what_other_packages_know)
    SETTINGS = with_precision(SETTINGS, Path("results") / SETTINGS.scale)
    PLAN = make_plan(SETTINGS, with_pdf=not missing_packages())
    check_scale(sys.argv[1:], SETTINGS.scale)
    check_places(PLAN)
except MobnetError as error:
    sys.exit(str(error))

config["scale"] = SETTINGS.scale  # the report names it
LOGS = PLAN.folders.results / "logs"
# Jobs that use a GPU wait for those of this machine; on a cluster they ask for one by --set-resources train:gpu=1.
GPUS = gpus_seen(version("torch"), os.environ) if workflow.nodes is None else 0
if GPUS and "gpu" not in workflow.global_resources:
    workflow.register_resource("gpu", GPUS)


onstart:
    if workflow.local_exec:
        drop_rate_limit(workflow)
    try:
        start_jobs(ROOT, are_here=workflow.local_exec)
        record_precision(PLAN.folders.results)
        made = {str(path) for job in workflow.dag.needrun_jobs() for path in job.output}
        check_space(PLAN, made)
        read = {str(path) for job in workflow.dag.needrun_jobs() for path in job.input}
        if RerunTrigger.PARAMS in workflow.dag_settings.rerun_triggers:  # else what other code has made is wanted
            refuse_lines(Stamped(PLAN).foreign(sorted(read - made)))
        if not workflow.local_exec:
            warm_cache(ROOT, jobs=len(list(workflow.dag.needrun_jobs())))
        if any(KINDS_OF_RULES.get(job.rule.name) == "train" for job in workflow.dag.needrun_jobs()):
            follow_trainings(PLAN.folders.results, Path(".cache") / "wandb_live.log")
    except MobnetError as error:
        sys.exit(str(error))


onerror:
    if not workflow.local_exec and not is_stopped():
        had = {
            job.rule.name: {name: job.resources.get(name) for name in LIMITED}
            for job in workflow.dag.needrun_jobs()
        }
        for line in failed_jobs(ROOT, STARTED_S, had):
            sys.stderr.write(f"{line}\n")


class Kind(NamedTuple):
    """What rules of a kind have in common: their group on a cluster, priority, memory [MB], time [min] and GPUs."""

    group: str
    priority: int
    mem_mb: int
    runtime: int
    gpus: int = 0


STEPS = {step.rule: step for step in (*PLAN.steps, *PLAN.trial_steps)}
KINDS_OF_RULES = {name: step.work.kind for name, step in STEPS.items()}
snakemake_logger.addFilter(by_kind(KINDS_OF_RULES))
set_resources_by_kind(workflow, KINDS_OF_RULES)


def growing(memory_mb):
    """Return what a job asks for in memory [MB], each time it is sent again as much more."""
    return lambda wildcards, attempt: attempt * memory_mb


def flagged(name):
    """Mark an output for Snakemake: a folder, or a file that the report shows with its caption."""
    output, how = ensure(name, non_empty=True) if Path(name).suffix else directory(name), shown(name)
    if how is None:
        return output
    labels = {"file": Path(name).stem, "shows": how.title}
    return report(output, caption=how.caption and ROOT / how.caption, category=how.category, labels=labels)
