"""Rule `coverage`: how much of the tests the training data cover, with and without random torque exploration."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.coverage import coverage

with job(snakemake.log[0]):
    coverage(snakemake.params.config, snakemake.params.training, snakemake.params.tests, Path(snakemake.output[0]).parent)
