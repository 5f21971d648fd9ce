"""HTML from templates."""

from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined


def rendered(template: Path, **values: Any) -> str:
    """Return the text of a template with the values in their places, escaped.

    A template may include others of its folder. A value that it needs and does not get is an error.
    """
    settings = Environment(
        loader=FileSystemLoader(template.parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return settings.get_template(template.name).render(values)
