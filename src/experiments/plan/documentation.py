"""The documentation, which no other product needs: `docs` makes its pages of documents, captions and docstrings."""

from collections.abc import Iterator
from pathlib import Path

from experiments.plan.call import Call
from experiments.plan.files import Files, made_by_jobs
from experiments.plan.products import CAPTIONS, Product

ROOT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "paper/README.md")
DOCUMENTS = "docs/**/*.*"
# All of them: docstrings and settings are shown, which the hash of the code leaves out.
MODULES = ("src/mobnet/**/*.py", "src/experiments/**/*.py")


def documentation(files: Files) -> Iterator[Product]:
    """Yield the pages of the documentation, the same at every scale."""
    modules: list[Path] = []
    for pattern in MODULES:
        modules += _found(pattern)
    given = {
        "documents": [*map(Path, ROOT), *_found(DOCUMENTS)],
        "captions": [*_found(f"{CAPTIONS}/figures/*.rst"), *_found(f"{CAPTIONS}/tables/*.rst")],
        "modules": modules,
    }
    out = files.shared / "docs"
    call = Call("experiments.evaluation.report.docs:docs", {**given, "claims": files.settings.claims, "out": out})
    yield Product("docs", call, tuple(made_by_jobs(given)), (str(out),))


def _found(pattern: str) -> list[Path]:
    """Return the files of the project's folder that match a pattern."""
    return sorted(Path().glob(pattern))
