"""List what can be hidden by its public name, so that a case is drawn by a word.

An effect is listed by its class, wherever in this folder that stands. A case is drawn by the position of its
cause in `EFFECTS`, so that a new effect takes the next free `draw_order` and leaves those before it in place.
"""

from collections.abc import Iterator
from importlib import import_module
from inspect import isclass
from pkgutil import iter_modules

from tests.plant import effects
from tests.plant.effects.effect import Effect


def _classes() -> Iterator[type[Effect]]:
    """List the effects of the folder that have a name, each where it is defined."""
    for found in iter_modules(effects.__path__, f"{effects.__name__}."):
        if not found.name.endswith(".registry"):
            for kind in vars(import_module(found.name)).values():
                own = isclass(kind) and kind.__module__ == found.name and issubclass(kind, Effect)
                if own and vars(kind).get("cause"):
                    yield kind


CLASSES: dict[str, type[Effect]] = {kind.cause: kind for kind in _classes()}
"""Every effect by its name."""

EFFECTS: dict[str, type[Effect]] = {
    kind.cause: kind for kind in sorted(CLASSES.values(), key=lambda kind: kind.draw_order) if kind.draw_order
}
"""The public enumeration of causes that can be hidden, in drawing order."""

FIRST = 29
LATER = tuple(EFFECTS)[FIRST:]
"""Those that were added later: drawn last as further effects, so that a seed's case stays the same."""

PARAMETERS: dict[str, set[str]] = {cause: set(kind.parameters) for cause, kind in EFFECTS.items()}
"""The parameters of these causes, as the public document names them."""

FOREIGN: dict[str, type[Effect]] = {
    cause: kind for cause, kind in CLASSES.items() if cause.startswith("foreign_")
}
"""Effects that are in no list."""
