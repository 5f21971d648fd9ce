"""Rule `score`: the errors of every run of a scenario."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.measure.scores import score

with job(snakemake.log[0]):
    score(
        snakemake.params.config,
        snakemake.wildcards.scenario,
        snakemake.params.entries,
        Path(snakemake.output[0]),
        snakemake.params.window,
    )
