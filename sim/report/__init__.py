"""The page of a comparison: every scene to be looked at, with its differences and numbers, in one file."""

from sim.report.page import Section, of_runs, section, write

__all__ = ["Section", "of_runs", "section", "write"]
