"""The thresholds of limbs that are watched all the time."""

from pathlib import Path

from experiments.jobs.calm import watch
from experiments.jobs.inputs import all_shards, placed
from experiments.running.logs import job

with job(snakemake.log[0]):
    watch(
        **placed(snakemake.params.given, snakemake.input),
        quiet=all_shards(snakemake.input.recordings, snakemake.params.seeds),
        out=Path(snakemake.output[0]),
    )
