"""The external torque of a test by all of its methods."""

from pathlib import Path

from experiments.jobs.estimates import estimate
from experiments.jobs.inputs import placed, shards
from experiments.running.logs import job

with job(snakemake.log[0]):
    estimate(
        **placed(snakemake.params.given, snakemake.input),
        recordings=shards(snakemake.input.recordings, snakemake.params.seeds),
        residuals=shards(snakemake.input.residuals, snakemake.params.seeds),
        out=Path(snakemake.output.estimates),
    )
