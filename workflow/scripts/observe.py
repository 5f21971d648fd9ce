"""The observer's residuals of recordings."""

from pathlib import Path

from experiments.jobs.inputs import shards
from experiments.jobs.observing import observe_walks
from experiments.running.logs import job

with job(snakemake.log[0]):
    observe_walks(
        **snakemake.params.given,
        recordings=shards(snakemake.input.recordings, snakemake.params.seeds),
        out=Path(snakemake.output.residuals),
    )
