"""A table, a figure or a text: the function that its row imports late, with the arguments that the plan makes.

A table to read gets its title above its rows.
"""

from pathlib import Path
from pkgutil import resolve_name

from experiments.jobs.inputs import placed
from experiments.plan.heads import put_head
from experiments.plan.product import Call
from experiments.running.logs import job

with job(snakemake.log[0]):
    given = placed(snakemake.params.given, [*snakemake.input, *snakemake.output])
    Call(resolve_name(snakemake.params.function), given).run()
    for table, head in snakemake.params.heads.items():
        put_head(placed(Path(table), snakemake.output), head)
