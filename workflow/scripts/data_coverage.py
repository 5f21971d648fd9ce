"""Rule `data_coverage`: what training covers of the tests; a coverage.py here would hide the package numba imports."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.coverage import coverage

with job(snakemake.log[0]):
    coverage(
        snakemake.params.config, snakemake.params.training, snakemake.params.tests, Path(snakemake.output[0]).parent
    )
