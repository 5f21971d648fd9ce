# Every table, figure and text of the plan, each by a rule of its own name, and the trials, films and documentation, which `all` does not ask for.

for product in (*PLAN.products, *PLAN.trials, *PLAN.films, *PLAN.docs):

    rule:
        name:
            product.name
        input:
            product.job.inputs,
        output:
            [flagged(name) for name in product.outputs],
        log:
            f"{LOGS}/{product.name}.log",
        group:
            "tables"
        threads: 1
        resources:
            mem_mb=growing(1700),
            runtime=10,
        params:
            call=product.job.call,
            given=lambda w, made=product.job: made.given,  # each start of a job on a cluster would hash all code
            stamps=product.job.stamps,
        script:
            "../scripts/call.py"
