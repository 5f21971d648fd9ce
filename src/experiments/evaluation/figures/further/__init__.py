"""Figures that this artifact adds."""
