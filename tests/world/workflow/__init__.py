"""Tests of set-up and workflow; they share `conftest`."""
