"""Rule `calibration`: how far the networks' standard deviations can be trusted."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.calibration import calibration

with job(snakemake.log[0]):
    calibration(
        snakemake.params.config,
        [str(Path(note).parent) for note in snakemake.input.notes],
        snakemake.params.tests,
        Path(snakemake.output[0]).parent,
        Path(snakemake.output.figure[0]).parent,
    )
