rule estimate:
    # The external torque of a test by every method that a table or figure shows of it.
    input:
        recordings=needed(JOBS.estimate, "recordings"),
        residuals=needed(JOBS.estimate, "residuals"),
        networks=needed(JOBS.estimate, "runs"),
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
        given=JOBS.estimate,
        code=code("estimate", JOBS.estimated_by),
    script:
        "../scripts/estimate.py"


rule score:
    # Errors of all of these estimates, of all robots together where the level is theirs.
    input:
        sets=needed(JOBS.score, "runs"),
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
