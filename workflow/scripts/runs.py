"""Rule `runs`: one page of all trainings with their curves."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.runs_page import runs_page

with job(snakemake.log[0]):
    folders = [Path(name).parent for name in snakemake.input.notes]
    runs_page(snakemake.params.config, folders, Path(snakemake.output[0]))
