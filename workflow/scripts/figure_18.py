"""Rule `figure_18`: Figure 18 of the paper, one network a limb against one for the whole body."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_18 import figure_18

with job(snakemake.log[0]):
    scores = {Path(name).stem: Path(name) for name in snakemake.input.scores}
    figure_18(snakemake.params.config, scores, Path(snakemake.output[0]).parent)
