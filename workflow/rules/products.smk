# Scores of all runs of a test; then every table, figure and text of the plan, each by a rule of its own name, and the
# trials, which `all` does not ask for.


rule score:
    input:
        lambda w: job("score", w).inputs,
    output:
        ensure(f"{PLAN.folders.results}/scores/{{scenario}}.csv", non_empty=True),
    log:
        f"{LOGS}/score/{{scenario}}.log",
    group:
        "scores"
    threads: 1
    resources:
        mem_mb=growing(500),
        runtime=5,
    params:
        call=lambda w: job("score", w).call,
        given=lambda w: job("score", w).given,
    script:
        "../scripts/call.py"


rule detect:
    input:
        lambda w: job("detect", w).inputs,
    output:
        [ensure(f"{OWN}detection/{name}.csv", non_empty=True) for name in DETECTION_FILES],
    log:
        f"{LOGS}/detect/{{robot}}all.log",
    group:
        "scores"
    threads: 1
    resources:
        mem_mb=growing(3000),
        runtime=20,
    params:
        call=lambda w: job("detect", w).call,
        given=lambda w: job("detect", w).given,
    script:
        "../scripts/call.py"


for product in (*PLAN.products, *PLAN.trials):

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
        script:
            "../scripts/call.py"
