"""How Sphinx builds the documentation: `./reproduce docs` puts this file, documents and made pages in one folder."""

import re
from importlib import import_module
from pathlib import Path

project = "MOB-Net, reproduced"
html_title = project
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "index"
html_theme = "furo"
html_static_path = ["docs/site.css"]
html_css_files = ["site.css"]
html_search_scorer = "docs/scorer.js"  # pages of modules come behind texts
html_copy_source = html_show_sourcelink = html_show_sphinx = html_show_copyright = False
html_show_search_summary = False  # it loads each page found, which a browser refuses without a server
html_last_updated_fmt = None  # the same pages on every day
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4  # as code hosts make them
autodoc_member_order = "bysource"
toc_object_entries = False  # menus show modules: with every function in them a third of the build is their copies
autodoc_typehints_format = "short"
default_role = "code"  # what docstrings set in single backticks
napoleon_google_docstring, napoleon_numpy_docstring = True, False
nitpicky = True  # every reference must lead somewhere, but for
nitpick_ignore_regex = [
    (r"py:.*", r"(?!mobnet\.).*"),  # types of Python and of packages: their documentation is on no disk
    (r"py:.*", r"(mobnet\.(settings|formats|control)|experiments)\..*"),  # they have no page of modules
    (r"py:.*", r"mobnet\..*\.(_\w+|Kind|Made|Named|Robot|Row|State|Stepped|Value)"),  # private names, names of types
]
ARRAY = re.compile(r"~?numpy\.ndarray\[tuple\[[^][]*\], ~?numpy\.dtype\[[^][]*\]\]")


def setup(app):  # noqa: ANN001, ANN201, D103
    app.connect("builder-inited", loaded)
    app.connect("autodoc-skip-member", skipped)
    app.connect("autodoc-process-signature", shortened)


def loaded(app):  # noqa: ANN001, ANN201
    """Import all modules that are shown: from a pydantic class that Sphinx has shown, no other one can be derived."""
    for page in sorted(Path(app.srcdir).glob("reference/*.md")):
        for name in re.findall(r"automodule:: (\S+)", page.read_text()):
            import_module(name)


def skipped(app, what, name, member, skip, options):  # noqa: ANN001, ANN201
    """Leave out the fields of a NamedTuple, which its docstring describes."""
    return True if type(member).__name__ == "_tuplegetter" else None


def shortened(app, what, name, member, options, arguments, returned):  # noqa: ANN001, ANN201
    """Call an array `ndarray` whatever its numbers are: docstrings tell shapes and units."""
    return tuple(text and ARRAY.sub("~numpy.ndarray", text) for text in (arguments, returned))
