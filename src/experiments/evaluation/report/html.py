"""HTML and Markdown from templates."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template, Undefined, UndefinedError


def rendered(template: Path, **values: Any) -> str:
    """Return the HTML of a template with the values in their places, escaped.

    A template may include others of its folder. A value that it needs and does not get is an error.
    """
    return _template(template, is_escaped=True).render(values)


def filled(template: Path, values: Mapping[str, Any]) -> str:
    """Return the text of a template that is no HTML, with the values in their places."""
    return _template(template, is_escaped=False).render(values)


def _template(template: Path, *, is_escaped: bool) -> Template:
    """Read a template."""
    settings = Environment(
        loader=FileSystemLoader(template.parent),
        autoescape=is_escaped,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        finalize=_not_a_function,
    )
    return settings.get_template(template.name)


def _not_a_function(value: Any) -> Any:
    """Return what a template prints; a function there was meant to be called."""
    if callable(value) and not isinstance(value, Undefined):
        raise UndefinedError("a field without its arguments in parentheses")
    return value
