"""What is used of Snakemake and stands in no documentation of it is there; an update that renames it fails here."""

import inspect
import re
from pathlib import Path

import pytest
from snakemake import cli, dag, rules, workflow
from snakemake.scheduling import job_scheduler

ROOT = Path(__file__).parents[3]
# name -> the module of Snakemake that has it, and how it is set there
UNDOCUMENTED = {
    "get_argument_parser": (cli, "def get_argument_parser("),  # takes words apart: targets, and options that name rules
    "needrun_jobs": (dag, "def needrun_jobs("),  # the jobs of a run: their price, their room, and what is begun
    "forcefiles": (dag, "self.forcefiles = set()"),  # what a stopped run has lost is made again
    "job_rate_limiter": (job_scheduler, "self.job_rate_limiter = "),  # half of a core after 100 jobs
    "register_resource": (workflow, "def register_resource("),  # jobs wait for the GPUs of this machine
    "is_producer": (rules, "def is_producer("),  # whether a rule makes a target
}
# Of Snakemake's `workflow`, what its documentation or that of its plug-ins names.
DOCUMENTED = {
    "basedir", "cores", "current_basedir", "dag", "dag.jobs", "global_resources", "is_main_process", "local_exec",
    "main_snakefile", "nodes", "rules", "scheduler",
}  # fmt: skip
USED = re.compile(r"\bself\._workflow\.([\w.]+)|\bworkflow\.([\w.]+)")


@pytest.mark.parametrize("name", UNDOCUMENTED)
def test_the_name_is_there(name):
    module, how = UNDOCUMENTED[name]
    assert how in inspect.getsource(module)


def names_in(path):
    """Return what is used of the object `workflow` in a file."""
    code = "\n".join(line.partition("#")[0] for line in path.read_text(encoding="utf-8").splitlines())
    return {"".join(found) for found in USED.findall(code)}


def test_no_other_name_of_the_workflow_is_used():
    places = [ROOT / "src" / "experiments" / "whole_run.py", *(ROOT / "workflow" / "rules").glob("*.smk")]
    used = set()
    for path in places:
        used |= names_in(path)
    unknown = {name for name in used - DOCUMENTED if not {*UNDOCUMENTED} & set(name.split("."))}
    assert unknown == set()
    assert {"forcefiles", "needrun_jobs", "job_rate_limiter"} <= {name.split(".")[1] for name in used if "." in name}
