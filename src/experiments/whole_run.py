"""A run of the workflow: what its rules share, and what happens before its first job and after its last one.

`workflow` below is Snakemake's. What is used of it, and is in no documentation of it, stands in one test
(tests/paper/workflow/test_snakemake_names.py).
"""

import os
import sys
import time
from collections.abc import Iterable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

from snakemake.cli import get_argument_parser
from snakemake.logging import logger

from experiments.evaluation.measure.estimates.scores import measure_problems
from experiments.evaluation.report.paper import missing_packages, unfit_words
from experiments.jobs.method_problems import method_problems
from experiments.plan.dry_run import PlannedJob
from experiments.plan.limits import limits
from experiments.plan.plan import (
    auto_precision,
    make_plan,
    record_precision,
    record_stacks,
    with_precision,
    with_stacks,
)
from experiments.plan.product import PAPER_NOTE
from experiments.plan.project import in_project
from experiments.plan.room import check_room, share_at_once
from experiments.plan.schedule import TimedJob
from experiments.plan.targets import asks_for_all, faults_of_words, made_line
from experiments.running.begun import BEGUN, lost, record_begun, record_end
from experiments.running.cluster import LIMITED, failed_jobs, warm_cache
from experiments.running.environment import sweep_project
from experiments.running.interrupts import Interrupts
from experiments.running.one_run import hold_folder, only_looks
from experiments.running.processes import end_orphans, follow_trainings
from experiments.running.progress import in_time
from experiments.running.terminal import SHOWN_BY
from experiments.running.words import refuse_twice, scale_of_targets
from experiments.settings.checks.claims import text_problems
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.code import UNKNOWN, commit
from mobnet.core.errors import MobnetError
from mobnet.core.files import check_room as check_folder
from mobnet.core.machine import gpus_seen
from mobnet.core.printed import end_where_full, watch_output
from mobnet.formats.reading import Problem
from mobnet.learning.precision import Precision

WRITTEN = (".snakemake", ".cache")  # Snakemake and packages write there
FOLLOWER_LOG = Path(".cache") / "wandb_live.log"
DOCS = "docs"  # the target
FIRST = {"collect": 0, "motion": 10, "observe": 30, "estimate": 30}  # rule -> priority where sets are let go
OTHERS = 20


class WorkflowRun:
    """A call of Snakemake for this workflow.

    Attributes:
        settings: the checked configuration.
        plan: what follows from it.
        limits: what jobs ask for in memory and time.
        gpus: number of GPUs here for which jobs wait; on a cluster they ask for one by --set-resources train:gpu=1.
    """

    def __init__(self, workflow: Any, config: dict[str, Any], root: Path, interrupts: Interrupts | None) -> None:
        """Check the words of the call and the configuration, and plan.

        A fault ends the process with one line.

        Args:
            workflow: Snakemake's.
            config: that of the call; it gets the scale, which the report names.
            root: folder of the project.
            interrupts: what answers signals; None in a job.
        """
        self._started_s = time.time()
        self._workflow = workflow
        self._root = root
        self._folder = Path.cwd()  # of results and of what Snakemake writes: the project, or that of --directory
        self._python = sys.executable
        self._interrupts = interrupts
        # The words are meant for these rules neither in a job nor in a module of others.
        self._is_main = workflow.is_main_process and Path(workflow.main_snakefile).parent == root
        self.gpus = gpus_seen(version("torch"), os.environ) if workflow.nodes is None else 0
        try:
            self._words = self._take_words() if self._is_main else None
            self._targets = [str(target) for target in self._words.targets] if self._words else []
            if scale := scale_of_targets(self._targets, config.get("scale")):
                config["scale"] = scale
            self.settings = self._load(config)
            self.plan = make_plan(self.settings, with_pdf=not missing_packages())
            self.limits = limits(self.plan)
        except MobnetError as error:
            sys.exit(str(error))
        config["scale"] = self.settings.scale
        if self.gpus and "gpu" not in workflow.global_resources:
            workflow.register_resource("gpu", self.gpus)
        self._begun = self.plan.folders.results / BEGUN
        self._lost = lost(self._begun) if self._is_main else []

    def _take_words(self) -> Any:
        """Keep other runs out, and return the words of the call as Snakemake takes them apart."""
        for name in WRITTEN:
            check_folder(self._folder / name)
        if not only_looks(sys.argv[1:]):
            hold_folder(self._folder, sys.argv[1:])
            end_orphans(self._folder)
        refuse_twice(sys.argv[1:])
        watch_output()
        words, _ = get_argument_parser().parse_known_args(sys.argv[1:])
        if words.dryrun:
            end_where_full(logger.handlers)  # it is for what it prints
        return words

    def _load(self, config: dict[str, Any]) -> Settings:
        """Return the configuration, with what is decided once for the results of its scale."""
        settings = load_settings(self._root / "configs", config, self._others_problems)
        results = Path("results") / settings.scale
        is_dry = bool(self._words and self._words.dryrun)
        self._precision: Precision | None = auto_precision(settings, results, is_dry=is_dry)
        return with_stacks(with_precision(settings, self._precision), results, self.gpus)

    def _others_problems(self, settings: Settings) -> Iterator[Problem]:
        """Yield what kinds of methods, modules of measures and the paper's text do not accept."""
        yield from method_problems(settings)
        yield from measure_problems(settings)
        yield from text_problems(settings, self._root / "paper" / "main.tex")

    def check_words(self) -> None:
        """End with one line where a word of the call names no target and no rule, once there are rules."""
        if self._words is None:
            return
        if DOCS in self._targets and not in_project():
            sys.exit(f"{DOCS}: the pages are made in the folder of the project alone; leave --directory out")
        rules = list(self._workflow.rules)
        fault = next(faults_of_words(self._words, rules, self.plan.shown, self.settings.scales), None)
        if fault:
            sys.exit(fault)

    def let_go_early(self) -> None:
        """Let jobs come first that read sets, and those last that make recordings: so little is there at once."""
        if self.settings.keep != "all":
            for rule in self._workflow.rules:
                rule.priority = FIRST.get(rule.name, OTHERS)

    def ask_for_lost(self) -> None:
        """Let what a stopped run has lost be made again where the targets need it.

        Snakemake has begun to ask what is to be made, and has not yet decided what of it runs.
        """
        self._workflow.dag.forcefiles.update(self._lost)

    def gone(self, names: Iterable[str]) -> list[str]:
        """Return what a whole run has made and somebody has removed."""
        if not self.plan.folders.manifest.exists():
            return []
        return [name for name in names if not Path(name).exists()]

    def begin(self) -> None:
        """Do what comes before the first job; a fault ends the process with one line."""
        if self._interrupts:
            self._interrupts.jobs_begin(are_local=self._workflow.local_exec)
        results = self.plan.folders.results
        jobs = list(self._workflow.dag.needrun_jobs())
        try:
            sweep_project(self._folder)  # no other run goes on here
            record_precision(results, self._precision)
            record_stacks(self.settings, results)
            record_begun(self._begun, self.plan.kept(str(output) for job in jobs for output in job.output))
            self._check_room(jobs)
            if not self._workflow.local_exec:
                warm_cache(self._python, self._root, jobs=len(jobs))
            if any(job.rule.name.startswith("train") for job in jobs):
                follow_trainings(self._python, results, FOLLOWER_LOG)
        except MobnetError as error:
            sys.exit(str(error))
        if commit() == UNKNOWN:
            unknown = "git knows no commit here, so results will not say which code made them (commit: unknown)"
            _say(f"{self._root}: {unknown}")
        if self._workflow.local_exec:
            # The number of cores limits the rate. Snakemake looks at all ready jobs in every timespan, once for each
            # job that has ended: half of a core after 100 jobs (its pull request 3744).
            self._workflow.scheduler.job_rate_limiter = None

    def _check_room(self, jobs: list[Any]) -> None:
        """Tell what shows the run how long its jobs will take, and check that there is room for what they write."""
        # This import takes a second, which the process of a job does not need.
        from experiments.evaluation.report.cost import expected_s

        planned = {job.jobid: PlannedJob.of(job) for job in jobs}
        seconds = expected_s(self.plan, planned)
        for handler in SHOWN_BY:
            handler.expect(seconds, waiting=len(jobs), made=len(self._workflow.dag.jobs) - len(jobs))
        share = 1.0
        if self.settings.keep != "all":
            timed = [TimedJob(job, seconds.get(number, 0.0)) for number, job in planned.items()]
            share = share_at_once(timed, self._workflow.cores or 1)
        check_room(jobs, share)

    def succeed(self) -> None:
        """Say what was made."""
        if self._interrupts:
            self._interrupts.jobs_ended()
        record_end(self._begun)
        folders = self.plan.folders
        if asks_for_all(self._targets) and (unfit := unfit_words(folders.paper / PAPER_NOTE)):
            told = f"{folders.results / 'logs' / 'paper.log'} names them"
            _say(f"{folders.paper / 'main.pdf'}: {len(unfit)} places of its text do not fit these results; {told}")
        made = made_line(self._targets, list(self._workflow.rules), folders)
        if self._words and self._words.report:
            made = f"{self._words.report} follows; {made}"
        _say(f"{made}, in {in_time(time.time() - self._started_s)}")

    def fail(self) -> None:
        """Say which jobs of a cluster failed; here each job has said so itself."""
        if self._workflow.local_exec:
            return
        had: dict[str, dict[str, int]] = {}
        for job in self._workflow.dag.needrun_jobs():
            had[str(job.log)] = {name: job.resources.get(name) for name in LIMITED}
        for line in failed_jobs(self._folder, self._started_s, had):
            _say(line)


def _say(line: str) -> None:
    """Print one line."""
    sys.stderr.write(f"{line}\n")
