"""The configuration of pages, and made-up trainings for them."""

from made_pages import settings, write_run

__all__ = ["settings", "write_run"]
