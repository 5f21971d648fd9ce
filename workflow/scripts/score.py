"""The errors of estimates."""

from pathlib import Path

from experiments.evaluation.measure.estimates.scores import score
from experiments.jobs.inputs import placed
from experiments.running.logs import job

with job(snakemake.log[0]):
    score(
        **placed(snakemake.params.given, snakemake.input),
        out=Path(snakemake.output[0]),
    )
