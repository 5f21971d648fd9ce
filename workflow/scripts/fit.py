"""A fit of a formula of friction."""

from pathlib import Path

from experiments.jobs.fitting import write_fit
from experiments.jobs.inputs import placed
from experiments.running.logs import job

with job(snakemake.log[0]):
    write_fit(
        **placed(snakemake.params.given, snakemake.input),
        out=Path(snakemake.output[0]),
    )
