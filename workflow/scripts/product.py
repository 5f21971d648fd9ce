"""A table, a figure or a text: the function that its row imports late, with the arguments that the plan makes."""

from pkgutil import resolve_name

from experiments.jobs.inputs import placed
from experiments.plan.product import Call
from experiments.running.logs import job

with job(snakemake.log[0]):
    given = placed(snakemake.params.given, [*snakemake.input, *snakemake.output])
    Call(resolve_name(snakemake.params.function), given).run()
