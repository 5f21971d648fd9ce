# What methods without networks learn from the training sets: one small file each.


rule fit:
    input:
        recordings=lambda w: sum(fitted_to(w.method, "recordings").values(), []),
        residuals=lambda w: sum(fitted_to(w.method, "residuals").values(), []),
    output:
        ensure(f"{RESULTS}/fits/{{method}}.json", non_empty=True),
    log:
        f"{RESULTS}/logs/fit/{{method}}.log",
    benchmark:
        f"{RESULTS}/bench/fit/{{method}}.tsv"
    priority: 10
    threads: 1
    params:
        config=lambda w: part(
            "robot", "observer", methods=[w.method], networks=settings["methods"][w.method].get("fitted", [])
        ),
        training=lambda w: fitted_pairs(w.method),
        robot=CONTENT["robot"],
        code=lambda w: code_of("fit", method=w.method),
    script:
        "../scripts/fit.py"
