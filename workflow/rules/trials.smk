# What `all` does not ask for: trials of methods, films and the documentation.


rule falls:
    # A robot's falls with random torques of several sizes.
    output:
        "<results>/{robot}/falls.csv",
    log:
        "<logs>/falls/{robot}.log",
    group:
        "walks"
    resources:
        **LIMITS.of("falls"),
    params:
        given=JOBS.falls,
        code=code("falls"),
    script:
        "../scripts/falls.py"


use rule table as trial with:
    # Variants of methods on walks of their own (configs/trials.yaml); their networks are trained as all others are.
    input:
        made_from=lambda w: PLAN.product(w.trial).inputs,
    output:
        multiext("<results>/trials/{trial}", ".csv", ".tex", ".md"),
    log:
        "<logs>/trials/{trial}.log",
    wildcard_constraints:
        trial=one_of(PLAN.made_by("trial")),
    resources:
        **LIMITS.of("{trial}"),
    params:
        function=lambda w: PLAN.product(w.trial).function,
        given=lambda w: PLAN.product(w.trial).arguments,
        code=lambda w: PLAN.product(w.trial).code,


use rule deviations as films with:
    # Films of walks into obstacles.
    input:
        made_from=PLAN.product("films").inputs,
    output:
        [flagged(name) for name in PLAN.product("films").outputs],
    log:
        "<logs>/films.log",
    resources:
        **LIMITS.of("films"),
    params:
        **PLAN.product("films").params,


use rule deviations as docs with:
    # The documentation as pages.
    input:
        documents=PLAN.product("docs").reads("documents"),
        captions=PLAN.product("docs").reads("captions"),
        modules=PLAN.product("docs").reads("modules"),
    output:
        [flagged(name) for name in PLAN.product("docs").outputs],
    log:
        "<logs>/docs.log",
    resources:
        **LIMITS.of("docs"),
    params:
        **PLAN.product("docs").params,
