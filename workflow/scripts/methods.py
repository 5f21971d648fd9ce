"""Rule `methods`: all methods side by side."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.methods import methods

with job(snakemake.log[0]):
    scores = {Path(name).stem: Path(name) for name in snakemake.input.scores}
    methods(snakemake.params.config, scores, Path(snakemake.output[0]).parent)
