rule estimate:
    # The external torque of a test by every method that a table or figure shows of it. All tests: ./reproduce sheet tests
    input:
        recordings=rules.collect.output.recordings,
        residuals=rules.observe.output.residuals,
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{robot}/{scenario}/{level}/networks", within=SHEETS.tests),
            file=TRAINED,
        ),
        fits=collect(
            "<results>/{fit.robot}/fits/{fit.name}.json",
            fit=lookup("{robot}/{scenario}/{level}/fits", within=SHEETS.tests),
        ),
    output:
        estimates=let_go(directory("<results>/{robot}/estimates/{scenario}/{level}")),
    log:
        "<logs>/estimate/{robot}/{scenario}-{level}.log",
    group:
        "estimates"
    resources:
        **LIMITS.of("estimate"),
        disk_mb=SIZES.estimates,
    params:
        seeds=lookup("{robot}/{scenario}/{level}/seeds", within=SHEETS.tests),
        given=JOBS.estimate,
        code=code("estimate", JOBS.estimated_by),
    script:
        "../scripts/estimate.py"


rule score:
    # Errors of all of these estimates, of all robots together where the level is theirs: ./reproduce sheet scores
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{scenario}/{level}/recordings", within=SHEETS.scores),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("{scenario}/{level}/residuals", within=SHEETS.scores),
        ),
        estimates=collect(
            "<results>/{set.robot}/estimates/{set.name}",
            set=lookup("{scenario}/{level}/estimates", within=SHEETS.scores),
        ),
    output:
        "<results>/scores/{scenario}/{level}.csv",
    log:
        "<logs>/score/{scenario}-{level}.log",
    group:
        "scores"
    resources:
        **LIMITS.of("score"),
    params:
        given=JOBS.score,
        code=code("score", JOBS.measured_by),
    script:
        "../scripts/score.py"
