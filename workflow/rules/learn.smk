# One network a limb, method and seed; then every method on every test.


rule train:
    input:
        recordings=lambda w: training("recordings", data_of(w.method, w.limb)),
        residuals=lambda w: training("residuals", data_of(w.method, w.limb)),
    output:
        weights=ensure(f"{RESULTS}/networks/{{method}}-{{limb}}-s{{seed}}/weights.safetensors", non_empty=True),
        metrics=ensure(f"{RESULTS}/networks/{{method}}-{{limb}}-s{{seed}}/metrics.csv", non_empty=True),
        note=ensure(f"{RESULTS}/networks/{{method}}-{{limb}}-s{{seed}}/run.json", non_empty=True),
    log:
        f"{RESULTS}/logs/train/{{method}}-{{limb}}-s{{seed}}.log",
    benchmark:
        f"{RESULTS}/bench/train/{{method}}-{{limb}}-s{{seed}}.tsv"
    priority: 10
    threads: 1
    params:
        config=lambda w: part("seed", "robot", "learning", methods=[w.method], networks=[w.limb])
        | training_sizes(w.method, w.limb),
        state=f"{RESULTS}/state/{{method}}-{{limb}}-s{{seed}}",
        robot=CONTENT["robot"],
        code=code_of("train"),
    script:
        "../scripts/train.py"


rule estimate:
    input:
        array=files("recordings"),
        note=files("recordings", "json"),
        networks=lambda w: [
            network(source_of(settings, w.method), limb, w.network_seed)
            for limb in limbs_of(source_of(settings, w.method))
        ],
        fit=lambda w: fit_of(w.method),
    output:
        array=ensure(files("estimates/{method}/n{network_seed}"), non_empty=True),
        note=ensure(files("estimates/{method}/n{network_seed}", "json"), non_empty=True),
    log:
        f"{RESULTS}/logs/estimate/{{method}}-n{{network_seed}}-{{scenario}}-{{level}}-s{{seed}}.log",
    benchmark:
        f"{RESULTS}/bench/estimate/{{method}}-n{{network_seed}}-{{scenario}}-{{level}}-s{{seed}}.tsv"
    wildcard_constraints:
        network_seed=r"\d+",
    threads: 1
    params:
        config=lambda w: part(
            "robot", "rates", "plant", "observer", levels=[w.level], methods=method_and_source(w.method)
        ),
        limbs=lambda w: limbs_of(source_of(settings, w.method)),
        robot=CONTENT["robot"],
        code=lambda w: code_of("estimate", method=w.method),
    script:
        "../scripts/estimate.py"
