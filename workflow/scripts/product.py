"""A table, a figure or a text: the call that the plan makes for it; a table to read gets its title above its rows."""

from pathlib import Path

from experiments.jobs.inputs import placed
from experiments.plan.call import Call
from experiments.plan.heads import put_head
from experiments.running.logs import job

with job(snakemake.log[0]):
    given = placed(snakemake.params.given, [*snakemake.input, *snakemake.output])
    Call(snakemake.params.function, given).run()
    for table, head in snakemake.params.heads.items():
        put_head(placed(Path(table), snakemake.output), head)
