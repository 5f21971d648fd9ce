"""Rule `motion`: a random motion of the upper body."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.simulation.motion import make_motion

with job(snakemake.log[0]):
    make_motion(
        snakemake.params.config,
        snakemake.wildcards.motion,
        int(snakemake.wildcards.seed),
        snakemake.params.duration_s,
        Path(snakemake.output.array).with_suffix(""),
    )
