"""The walks of a robot in a case."""

from pathlib import Path

from experiments.jobs.react import react
from experiments.running.logs import job

with job(snakemake.log[0]):
    react(**snakemake.params.given, out=Path(snakemake.output[0]))
