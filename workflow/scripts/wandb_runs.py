"""Rule `wandb_runs`: all trainings as offline wandb runs."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.wandb_runs import wandb_runs

with job(snakemake.log[0]):
    wandb_runs([Path(name).parent for name in snakemake.input.notes], Path(snakemake.output[0]))
