"""What is used of Snakemake and stands in no documentation of it is there; an update that renames it fails here."""

import re
from pathlib import Path

import pytest
from snakemake.cli import get_argument_parser
from snakemake.dag import DAG
from snakemake.rules import Rule
from snakemake.scheduling.job_scheduler import JobScheduler
from snakemake.workflow import Workflow

ROOT = Path(__file__).parents[3]
# name -> what says that it is there; `self.NAME =` stands in the source of what sets it
PRIVATE = {
    "get_argument_parser": get_argument_parser,  # takes the words of a call apart, for targets and names of rules
    "dag.needrun_jobs": DAG.needrun_jobs,  # the jobs of a run: their price, room, and what is noted as begun
    "dag.forcefiles": "self.forcefiles = set()",  # what a stopped run has lost is made again
    "scheduler.job_rate_limiter": "self.job_rate_limiter = ",  # half of a core after 100 jobs (pull request 3744)
    "register_resource": Workflow.register_resource,  # jobs wait for the GPUs of this machine
    "is_producer": Rule.is_producer,  # whether a rule makes a target
}
OWN = {"dag.forcefiles": DAG, "scheduler.job_rate_limiter": JobScheduler}
# Of the object `workflow`, and of rules and jobs, what the documentation of Snakemake, or of its plug-ins, shows.
DOCUMENTED = {
    "dag", "scheduler", "rules", "cores", "nodes", "basedir", "current_basedir", "main_snakefile", "is_main_process", "local_exec",
    "global_resources",
}  # fmt: skip
USED = re.compile(r"\bworkflow\.(\w+(?:\.\w+)?)")


@pytest.mark.parametrize("name", PRIVATE)
def test_the_name_is_there(name):
    found = PRIVATE[name]
    if isinstance(found, str):
        module = __import__(OWN[name].__module__, fromlist=["x"])
        assert found in Path(module.__file__).read_text(encoding="utf-8")
    assert found


def test_no_other_name_is_used():
    files = [ROOT / "Snakefile", ROOT / "src/experiments/whole_run.py", *(ROOT / "workflow" / "rules").glob("*.smk")]
    used = {
        name
        for path in files
        for name in USED.findall(path.read_text(encoding="utf-8").replace("_workflow", "workflow"))
    }
    known = {*PRIVATE, *DOCUMENTED, "dag.jobs", "rst"}
    assert {
        name for name in used if name not in known and name.partition(".")[0] not in DOCUMENTED - {"dag", "scheduler"}
    } == set()
