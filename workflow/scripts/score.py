"""The errors of estimates."""

from pathlib import Path

from experiments.evaluation.measure.estimates.scores import score
from experiments.running.logs import job

with job(snakemake.log[0]):
    score(**snakemake.params.given, out=Path(snakemake.output[0]))
