"""The training of a network."""

from pathlib import Path

from experiments.jobs.trainings import train
from experiments.running.logs import job

with job(snakemake.log[0]):
    train(**snakemake.params.given, out=Path(snakemake.output.weights).parent)
