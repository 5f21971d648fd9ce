"""The training of a network."""

from pathlib import Path

from experiments.jobs.inputs import all_shards, only, placed
from experiments.jobs.trainings import train
from experiments.running.logs import job

with job(snakemake.log[0]):
    train(
        **placed(snakemake.params.given, snakemake.input),
        recordings=all_shards(snakemake.input.recordings, snakemake.params.seeds),
        residuals=all_shards(snakemake.input.residuals, snakemake.params.seeds),
        start=only(snakemake.input.start),
        fitted=only(snakemake.input.fitted),
        out=Path(snakemake.output.weights).parent,
    )
