# What the rules share: the checked configuration, the plan that follows from it, and what each job depends on.

import shlex
import sys

from experiments.running.interrupts import Interrupts

# Ctrl-C is answered from here on: all that is imported below takes a second.
INTERRUPTS = Interrupts() if workflow.is_main_process else None

from experiments.plan.files import TRAINED
from experiments.plan.products import shown as report_of
from experiments.plan.project import project_file
from experiments.plan.room import Sizes
from experiments.plan.sheets import Sheets
from experiments.records.collisions import FILES
from experiments.running.environment import quieten
from experiments.running.processes import PREFIX
from experiments.running.words import one_of
from experiments.whole_run import WorkflowRun
from mobnet.core.code import code_hash

ROOT = Path(workflow.current_basedir).parent.parent
quieten(ROOT)
RUN = WorkflowRun(workflow, config, ROOT, INTERRUPTS)
SETTINGS = RUN.settings
PLAN = RUN.plan
JOBS = PLAN.jobs
LIMITS = RUN.limits
SIZES = Sizes(JOBS)
SHEETS = Sheets(PLAN)
SHOWN = SHEETS.shown  # what tables, figures and texts are made from
GPUS = RUN.gpus

sys.executable = shlex.quote(sys.executable)  # Snakemake writes it into shell commands as it is
shell.prefix(PREFIX)


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
    RUN.begin()


onsuccess:
    RUN.succeed()


onerror:
    RUN.fail()


def lookup(dpath, within):
    """Return a function of wildcards: the column of a sheet's row that they name, as ROW/COLUMN.

    It takes the place of Snakemake's function of this name, which goes through the whole sheet each time: 18 ms for a
    network of the default scale, where a run has thousands of look-ups.
    """

    def look(w):
        RUN.ask_for_lost()
        row, _, column = dpath.format_map(dict(w.items())).rpartition("/")
        return within[row][column]

    return look


def product(name):
    """Return the parameters of the rule of a product, a table, figure or text whose name may have a wildcard.

    They are worked out late: a hash of code takes its time.
    """

    def found(w):
        return PLAN.product(name.format_map(dict(w.items())))

    return {
        "function": lambda w: found(w).function,
        "given": lambda w: found(w).arguments,
        "heads": lambda w: found(w).heads,
        "code": lambda w: found(w).code,
    }


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
    """Mark a file of a product whose rule makes nothing else for the report, with its caption, if it is shown there."""
    how = report_of(name)
    if how is None:
        return name
    labels = {"file": Path(name).stem, "shows": how.title}
    # Results lie in the working folder, also captions with numbers, which are there once a report is made.
    caption = how.caption and PLAN.folders.caption(how.caption)
    if caption:
        caption = (ROOT if caption == how.caption else Path.cwd()) / caption
    return report(name, caption=caption, category=how.category, labels=labels)


def let_go(output):
    """Mark a set that is removed when nothing needs it any more, if the configuration says so."""
    return output if SETTINGS.keep == "all" else temp(output)
