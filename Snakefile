# From an empty folder to every table and figure: collect -> observe -> train -> estimate -> score -> tables, paper.
# `snakemake --cores 2` makes all of it at the scale that configs/config.yaml names; --config scale=smoke takes minutes.


configfile: "configs/config.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/collect.smk"
include: "workflow/rules/fit.smk"
include: "workflow/rules/learn.smk"
include: "workflow/rules/data.smk"
include: "workflow/rules/evaluate.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/ablations.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/runs.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/pages.smk"


rule all:
    default_target: True
    input:
        PRODUCTS,
        MANIFEST,
        WANDB,
        COMPUTE,
        rules.pages.output,
