"""The walks of a robot in a case."""

from pathlib import Path

from experiments.jobs.inputs import placed
from experiments.jobs.react import react
from experiments.running.logs import job

with job(snakemake.log[0]):
    react(
        **placed(snakemake.params.given, snakemake.input),
        thresholds=[Path(file) for file in snakemake.input.thresholds],
        out=Path(snakemake.output[0]),
    )
