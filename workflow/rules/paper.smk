# The paper, the pages of the report, and what looks at all other results.


rule deviations:
    # What differs from the paper, for its text.
    input:
        markdown=PLAN.product("deviations").reads("markdown"),
    output:
        [flagged(name) for name in PLAN.product("deviations").outputs],
    log:
        "<logs>/deviations.log",
    group:
        "tables"
    resources:
        **LIMITS.of("deviations"),
    params:
        **PLAN.product("deviations").params,
    script:
        "../scripts/product.py"


use rule deviations as numbers with:
    # Numbers and captions that the text takes, and the tables of its main part.
    input:
        made_from=PLAN.product("numbers").inputs,
    output:
        [flagged(name) for name in PLAN.product("numbers").outputs],
    log:
        "<logs>/numbers.log",
    resources:
        **LIMITS.of("numbers"),
    params:
        **PLAN.product("numbers").params,


use rule deviations as compute with:
    # What the jobs took, by their accounts.
    input:
        after=[*rules.tables.input, *rules.figures.input, *rules.pictures.output],
    output:
        [flagged(name) for name in PLAN.product("compute").outputs],
    log:
        "<logs>/compute.log",
    resources:
        **LIMITS.of("compute"),
    params:
        **PLAN.product("compute").params,


use rule deviations as paper with:
    # The paper; its PDF only where there is TeX.
    input:
        main=PLAN.product("paper").reads("main"),
        references=PLAN.product("paper").reads("references"),
        tables=PLAN.product("paper").reads("tables"),
        figures=PLAN.product("paper").reads("figures"),
    output:
        [flagged(name) for name in PLAN.product("paper").outputs],
    log:
        "<logs>/paper.log",
    resources:
        **LIMITS.of("paper"),
    params:
        **PLAN.product("paper").params,


use rule deviations as runs_page with:
    # A page with the courses of all trainings.
    input:
        folders=PLAN.product("runs_page").reads("folders"),
        templates=PLAN.product("runs_page").reads("templates"),
        scores=PLAN.product("runs_page").reads("scores"),
    output:
        [flagged(name) for name in PLAN.product("runs_page").outputs],
    log:
        "<logs>/runs_page.log",
    resources:
        **LIMITS.of("runs_page"),
    params:
        **PLAN.product("runs_page").params,


use rule deviations as wandb_runs with:
    # The trainings as offline runs of Weights & Biases.
    input:
        folders=PLAN.product("wandb_runs").reads("folders"),
        scores=PLAN.product("wandb_runs").reads("scores"),
    output:
        [flagged(name) for name in PLAN.product("wandb_runs").outputs],
    log:
        "<logs>/wandb_runs.log",
    resources:
        **LIMITS.of("wandb_runs"),
    params:
        **PLAN.product("wandb_runs").params,


use rule deviations as demo_data with:
    # The push of `./reproduce demo`.
    input:
        made_from=PLAN.product("demo_data").inputs,
    output:
        [flagged(name) for name in PLAN.product("demo_data").outputs],
    log:
        "<logs>/demo_data.log",
    resources:
        **LIMITS.of("demo_data"),
    params:
        **PLAN.product("demo_data").params,


use rule deviations as explore with:
    # A page on which a reader plays with pushes.
    input:
        made_from=PLAN.product("explore").inputs,
    output:
        [flagged(name) for name in PLAN.product("explore").outputs],
    log:
        "<logs>/explore.log",
    resources:
        **LIMITS.of("explore"),
    params:
        **PLAN.product("explore").params,


use rule deviations as pages with:
    # The pages of the report, one for each table.
    input:
        made_from=PLAN.product("pages").inputs,
    output:
        [flagged(name) for name in PLAN.product("pages").outputs],
    log:
        "<logs>/pages.log",
    resources:
        **LIMITS.of("pages"),
    params:
        **PLAN.product("pages").params,


use rule deviations as manifest with:
    # The hash of every file of results.
    input:
        sets=PLAN.sets,
        products=PLAN.listed,
    output:
        [flagged(name) for name in PLAN.product("manifest").outputs],
    log:
        "<logs>/manifest.log",
    resources:
        **LIMITS.of("manifest"),
    params:
        **PLAN.product("manifest").params,
