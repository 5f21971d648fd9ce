"""How often a robot falls with each random torque."""

from pathlib import Path

from experiments.evaluation.measure.data.random_torque import count_falls
from experiments.running.logs import job

with job(snakemake.log[0]):
    count_falls(**snakemake.params.given, out=Path(snakemake.output[0]))
