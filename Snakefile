# From an empty folder to every table and figure of the paper. `snakemake --cores 2` makes all of it at the scale that
# configs/config.yaml names; `--config scale=smoke` takes minutes. A file of rules for each stage of the paper:

import sys
from pathlib import Path

sys.path.insert(0, str(Path(workflow.current_basedir) / "src"))  # of this folder, whatever Python reads this file


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
        rules.tables.input,
        rules.figures.input,
        rules.pictures.output,
        rules.paper.output,
        rules.pages.output,
        rules.runs_page.output,
        rules.explore.output,
        rules.demo_data.output,
        rules.wandb_runs.output,
        rules.manifest.output,


check_targets()
let_go_early()
