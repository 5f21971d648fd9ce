"""The training of a network."""

from pathlib import Path

from experiments.jobs.inputs import all_shards, only
from experiments.jobs.trainings import train
from experiments.running.logs import job

with job(snakemake.log[0]):
    train(
        **snakemake.params.given,
        recordings=all_shards(snakemake.input.recordings, snakemake.params.seeds),
        residuals=all_shards(snakemake.input.residuals, snakemake.params.seeds),
        start=only(snakemake.input.start),
        fitted=only(snakemake.input.fitted),
        stack=only(snakemake.input.stack),
        out=Path(snakemake.output.weights).parent,
    )
