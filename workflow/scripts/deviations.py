"""Rule `deviations`: the table of deviations as TeX."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.deviations import deviations

with job(snakemake.log[0]):
    deviations(Path(snakemake.input[0]), Path(snakemake.output[0]))
