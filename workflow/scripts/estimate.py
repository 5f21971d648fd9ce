"""The external torque of a test by all of its methods."""

from pathlib import Path

from experiments.jobs.estimates import estimate
from experiments.running.logs import job

with job(snakemake.log[0]):
    estimate(**snakemake.params.given, out=Path(snakemake.output.estimates))
