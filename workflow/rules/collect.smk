# Recordings of the walking robot, and what the observer makes of them.


rule motion:
    output:
        array=ensure(f"{RESULTS}/motions/{{motion}}/s{{seed}}.parquet", non_empty=True),
        note=ensure(f"{RESULTS}/motions/{{motion}}/s{{seed}}.json", non_empty=True),
    log:
        f"{RESULTS}/logs/motion/{{motion}}-s{{seed}}.log",
    benchmark:
        f"{RESULTS}/bench/motion/{{motion}}-s{{seed}}.tsv"
    priority: 30
    threads: 1
    params:
        config=lambda w: part("seed", "robot", "walking", motions=[w.motion]),
        duration_s=lambda w: duration_s(moved_by(w.motion), w.seed),
        robot=CONTENT["robot"],
        code=code_of("motion"),
    script:
        "../scripts/motion.py"


rule collect:
    input:
        motion=lambda w: motion_of(w.scenario, w.seed),
    output:
        array=ensure(files("recordings"), non_empty=True),
        note=ensure(files("recordings", "json"), non_empty=True),
    log:
        f"{RESULTS}/logs/collect/{{scenario}}-{{level}}-s{{seed}}.log",
    benchmark:
        f"{RESULTS}/bench/collect/{{scenario}}-{{level}}-s{{seed}}.tsv"
    priority: 20
    threads: 1
    params:
        config=lambda w: part(
            "seed",
            "robot",
            "rates",
            "plant",
            "commands",
            "random_torque",
            "recording",
            "walking",
            levels=[w.level],
            scenarios=[w.scenario],
            terrain=settings["scenarios"][w.scenario]["terrain"],
            pushes=settings["scenarios"][w.scenario].get("pushes", []),
        ),
        duration_s=lambda w: duration_s([w.scenario], w.seed),
        robot=CONTENT["robot"],
        code=code_of("collect"),
    script:
        "../scripts/collect.py"


rule observe:
    input:
        array=files("recordings"),
        note=files("recordings", "json"),
    output:
        array=ensure(files("residuals"), non_empty=True),
        note=ensure(files("residuals", "json"), non_empty=True),
    log:
        f"{RESULTS}/logs/observe/{{scenario}}-{{level}}-s{{seed}}.log",
    benchmark:
        f"{RESULTS}/bench/observe/{{scenario}}-{{level}}-s{{seed}}.tsv"
    priority: 20
    threads: 1
    params:
        config=lambda w: part("robot", "rates", "plant", "observer", levels=[w.level]),
        robot=CONTENT["robot"],
        code=code_of("observe"),
    script:
        "../scripts/observe.py"
