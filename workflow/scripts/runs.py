"""Rule `runs`: one page of all trainings with their curves."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.runs_page import runs_page

with job(snakemake.log[0]):
    notes, metrics = ([Path(name) for name in names] for names in (snakemake.input.notes, snakemake.input.metrics))
    runs_page(snakemake.params.config, notes, metrics, Path(snakemake.output[0]))
