# From an empty folder to every table and figure of the paper. `snakemake --cores 2` makes all of it at the scale that
# configs/config.yaml names; `--config scale=smoke` takes minutes. A file of rules for each stage of the paper:

import sys
from pathlib import Path

sys.path.insert(0, str(Path(workflow.current_basedir) / "src"))  # of this folder, whatever Python reads this file

from experiments.running.environment import fault_of_process, fault_of_snakemake

# Before the first file that needs packages, or words of Snakemake that older ones do not know.
if fault := fault_of_process(Path(workflow.current_basedir)) or fault_of_snakemake():
    sys.exit(fault)


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/collect.smk"  # section 4.3: motions, recordings, residuals
include: "workflow/rules/learn.smk"  # section 4.4: fits and networks
include: "workflow/rules/estimate.smk"  # section 5: estimates of the external torque, and their errors
include: "workflow/rules/detect.smk"  # sections 5.3 and 5.4: detectors and reactions
include: "workflow/rules/tables.smk"  # tables and figures
include: "workflow/rules/paper.smk"  # the paper, the pages and the list of all results
include: "workflow/rules/trials.smk"  # what `all` does not ask for


rule all:
    default_target: True
    input:
        rules.manifest.output,
        rules.wandb_runs.output,
        RUN.gone(rules.manifest.input),  # Snakemake misses a file that it is asked for, not one that lies between


RUN.check_words()
RUN.let_go_early()
