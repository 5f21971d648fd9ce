"""What kinds of estimators do not accept of the configuration: read before a run begins."""

from collections.abc import Iterator

from pydantic import ValidationError

from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from mobnet.core.errors import not_accepted
from mobnet.estimation.kinds import kind_names, kind_of
from mobnet.formats.base import Section
from mobnet.formats.faults import problems
from mobnet.formats.reading import Place


def method_problems(settings: Settings) -> Iterator[tuple[Place, str]]:
    """Yield the place and the text of every kind, option or key of a method that its kind does not accept."""
    tried = Catalogue(settings).tried
    for name, method in {**settings.methods, **tried}.items():
        place: Place = ("trials",) if name in tried else ("methods", name)
        if method.kind not in kind_names():
            yield (*place, "kind"), not_accepted("kind", method.kind, kind_names())
            continue
        kind = kind_of(name, method.kind)
        section = getattr(kind, "Options", Section)
        try:
            options = section.model_validate(method.options)
        except ValidationError as error:
            faults = problems(error, section, method.options)
            yield from (((*place, "options", *inner), text) for inner, text in faults)
        else:
            check = getattr(kind, "check", None)
            faults = check(method, options, settings.rates.data_hz) if check else ()
            yield from (((*place, *inner), text) for inner, text in faults)
