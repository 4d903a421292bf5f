"""The page of a comparison: every scene to be looked at, with its differences and numbers, in one file."""

from sim.report.page import DATA, Section, of_runs, section, write

__all__ = ["DATA", "Section", "of_runs", "section", "write"]
