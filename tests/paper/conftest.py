"""The whole configuration at its smoke scale in place of the library's part of it."""

from paper_settings import recipe_of, settings

__all__ = ["recipe_of", "settings"]
