"""The training of networks side by side."""

from pathlib import Path

from experiments.jobs.stacks import train_stack
from experiments.running.logs import job

with job(snakemake.log[0]):
    train_stack(**snakemake.params.given, out=Path(snakemake.output[0]))
