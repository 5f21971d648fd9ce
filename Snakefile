# From an empty folder to every table and figure: collect -> train -> estimate -> score -> tables, paper.
# `snakemake --cores 2` makes all of it at the scale that configs/config.yaml names; --config scale=smoke takes minutes.
# What is made from what stands in src/experiments/plan.

import sys
from pathlib import Path

sys.path.insert(0, f"{workflow.basedir}/src")  # of this folder, whatever Python reads this file

from experiments.running.environment import fault_of_process
from experiments.running.run import prepare

if fault := fault_of_process(Path(workflow.basedir)):
    sys.exit(fault)
if workflow.is_main_process:
    prepare(Path(workflow.basedir))


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/steps.smk"
include: "workflow/rules/products.smk"


rule all:
    default_target: True
    input:
        PLAN.stored,
        [product.outputs for product in PLAN.products],
