"""A random motion of the upper body."""

from pathlib import Path

from experiments.jobs.motions import make_motion
from experiments.running.logs import job

with job(snakemake.log[0]):
    make_motion(**snakemake.params.given, out=Path(snakemake.output[0]).with_suffix(""))
