"""Recordings of a scenario, one for each seed."""

from pathlib import Path

from experiments.jobs.inputs import stems
from experiments.jobs.walks import collect_walks
from experiments.running.logs import job

with job(snakemake.log[0]):
    collect_walks(
        **snakemake.params.given,
        motions=stems(snakemake.input.motions),
        out=Path(snakemake.output.recordings),
    )
