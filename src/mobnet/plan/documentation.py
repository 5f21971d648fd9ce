"""The documentation, which no other product needs: `docs` makes its pages of documents, captions and docstrings."""

from collections.abc import Iterator
from pathlib import Path

from mobnet.plan.call import Call, Job
from mobnet.plan.files import Files, files_in
from mobnet.plan.products import CAPTIONS, Product

ROOT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "paper/README.md")
DOCUMENTS = "docs/**/*.*"
MODULES = "src/mobnet/**/*.py"  # all of them: docstrings and settings are shown, which the hash of the code leaves out


def documentation(files: Files) -> Iterator[Product]:
    """Yield the pages of the documentation, the same at every scale."""
    given = {
        "documents": [*map(Path, ROOT), *_found(DOCUMENTS)],
        "captions": [*_found(f"{CAPTIONS}/figures/*.rst"), *_found(f"{CAPTIONS}/tables/*.rst")],
        "modules": _found(MODULES),
    }
    out = files.results / "docs"
    call = Call("mobnet.evaluation.report.docs:docs", {**given, "claims": files.settings.claims, "out": out})
    yield Product("docs", Job(call, tuple(map(str, files_in(given)))), (str(out),))


def _found(pattern: str) -> list[Path]:
    """Return the files of the project's folder that match a pattern."""
    return sorted(Path().glob(pattern))
