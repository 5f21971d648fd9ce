# The paper, the pages of the report, and what looks at all other results.


rule deviations:
    # What differs from the paper, for its text.
    input:
        markdown=project_file("docs/deviations.md"),
    output:
        "<tables>/deviations.tex",
    log:
        "<logs>/deviations.log",
    group:
        "tables"
    resources:
        **LIMITS.of("deviations"),
    params:
        **product("deviations"),
    script:
        "../scripts/product.py"


rule numbers:
    # Numbers and captions that the text takes, and the tables of its main part.
    input:
        tables=collect("<tables>/{name}.csv", name=lookup("numbers/tables", within=SHOWN)),
        files=lookup("numbers/files", within=SHOWN),
    output:
        [flagged(name) for name in PLAN.product("numbers").outputs],
    log:
        "<logs>/numbers.log",
    group:
        "tables"
    resources:
        **LIMITS.of("numbers"),
    params:
        **product("numbers"),
    script:
        "../scripts/product.py"


rule compute:
    # What the jobs took, by their accounts.
    input:
        after=[*rules.tables.input, *rules.figures.input, *rules.pictures.output],
    output:
        multiext("<results>/compute", ".csv", ".tex", ".md"),
    log:
        "<logs>/compute.log",
    group:
        "tables"
    resources:
        **LIMITS.of("compute"),
    params:
        **product("compute"),
    script:
        "../scripts/product.py"


rule paper:
    # The paper; its PDF only where there is TeX.
    input:
        main=project_file("paper/main.tex"),
        references=project_file("paper/refs.bib"),
        tables=expand("<tables>/{table}.tex", table=[*PLAN.tables, "numbers", "captions", "deviations"]),
        compute="<results>/compute.tex",
        trial=project_file("docs/trials/factorial.tex"),
        figures=expand("<figures>/{figure}.pdf", figure=PLAN.drawn),
    output:
        [flagged(name) for name in PLAN.product("paper").outputs],
    log:
        "<logs>/paper.log",
    group:
        "tables"
    resources:
        **LIMITS.of("paper"),
    params:
        **product("paper"),
    script:
        "../scripts/product.py"


rule runs_page:
    # A page with the courses of all trainings.
    input:
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("runs_page/networks", within=SHOWN),
            file=TRAINED,
        ),
        scores=collect("<results>/scores/{test}.csv", test=lookup("runs_page/scores", within=SHOWN)),
        templates=lookup("runs_page/files", within=SHOWN),
    output:
        flagged("<results>/runs.html"),
    log:
        "<logs>/runs_page.log",
    group:
        "tables"
    resources:
        **LIMITS.of("runs_page"),
    params:
        **product("runs_page"),
    script:
        "../scripts/product.py"


rule wandb_runs:
    # The trainings as offline runs of Weights & Biases.
    input:
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("wandb_runs/networks", within=SHOWN),
            file=TRAINED,
        ),
        scores=collect("<results>/scores/{test}.csv", test=lookup("wandb_runs/scores", within=SHOWN)),
    output:
        directory("<results>/wandb"),
    log:
        "<logs>/wandb_runs.log",
    group:
        "tables"
    resources:
        **LIMITS.of("wandb_runs"),
    params:
        **product("wandb_runs"),
    script:
        "../scripts/product.py"


rule demo_data:
    # The push of `./reproduce demo`, with the networks and fits that it needs.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("demo_data/recordings", within=SHOWN),
        ),
        estimates=collect(
            "<results>/{set.robot}/estimates/{set.name}",
            set=lookup("demo_data/estimates", within=SHOWN),
        ),
        detections=collect(
            "<results>/{own.robot}/detection/{own.name}.csv",
            own=lookup("demo_data/detections", within=SHOWN),
        ),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("demo_data/networks", within=SHOWN),
            file=["weights.safetensors", "run.json"],
        ),
        fits=collect("<results>/{fit.robot}/fits/{fit.name}.json", fit=lookup("demo_data/fits", within=SHOWN)),
    output:
        [flagged(name) for name in PLAN.product("demo_data").outputs],
    log:
        "<logs>/demo_data.log",
    group:
        "tables"
    resources:
        **LIMITS.of("demo_data"),
    params:
        **product("demo_data"),
    script:
        "../scripts/product.py"


rule explore:
    # A page on which a reader plays with pushes.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("explore/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("explore/residuals", within=SHOWN)),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("explore/estimates", within=SHOWN)),
        detections=collect(
            "<results>/{own.robot}/detection/{own.name}.csv",
            own=lookup("explore/detections", within=SHOWN),
        ),
        templates=lookup("explore/files", within=SHOWN),
    output:
        flagged("<results>/explore.html"),
    log:
        "<logs>/explore.log",
    group:
        "tables"
    resources:
        **LIMITS.of("explore"),
    params:
        **product("explore"),
    script:
        "../scripts/product.py"


rule pages:
    # The pages of the report, one for each table, from their Markdown, their captions with numbers, and templates.
    input:
        tables=collect("<tables>/{name}.csv", name=lookup("pages/tables", within=SHOWN)),
        files=lookup("pages/files", within=SHOWN),
    output:
        [flagged(f"<results>/pages/{name}.html") for name in [*PLAN.tables, "compute", "index"]],
    log:
        "<logs>/pages.log",
    group:
        "tables"
    resources:
        **LIMITS.of("pages"),
    params:
        **product("pages"),
    script:
        "../scripts/product.py"


rule manifest:
    # The hash of every file of results.
    input:
        sets=PLAN.sets,
        products=PLAN.listed,
    output:
        [flagged(name) for name in PLAN.product("manifest").outputs],
    log:
        "<logs>/manifest.log",
    group:
        "tables"
    resources:
        **LIMITS.of("manifest"),
    params:
        **product("manifest"),
    script:
        "../scripts/product.py"
