"""Rule `compute`: jobs, hours and memory of each stage."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.compute import compute

with job(snakemake.log[0]):
    folders = (Path(name) for name in (snakemake.params.benchmarks, snakemake.params.logs))
    compute(snakemake.params.config, *folders, Path(snakemake.output[0]).parent)
