"""The training of a network on what a fit leaves."""

from pathlib import Path

from experiments.jobs.train_gray import train_gray
from experiments.running.logs import job

with job(snakemake.log[0]):
    train_gray(**snakemake.params.given, out=Path(snakemake.output.weights).parent)
