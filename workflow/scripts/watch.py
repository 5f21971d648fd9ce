"""The thresholds of limbs that are watched all the time."""

from pathlib import Path

from experiments.jobs.calm import watch
from experiments.running.logs import job

with job(snakemake.log[0]):
    watch(**snakemake.params.given, out=Path(snakemake.output[0]))
