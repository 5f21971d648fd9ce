"""The training of networks side by side."""

from pathlib import Path

from experiments.jobs.inputs import placed
from experiments.jobs.stacks import train_stack
from experiments.running.logs import job

with job(snakemake.log[0]):
    train_stack(
        **placed(snakemake.params.given, snakemake.input),
        out=Path(snakemake.output[0]),
    )
