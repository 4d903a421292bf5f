"""The page of a comparison: every scene with its pictures, differences and figures, in one file. The commands and
`sim.figures` import it; it imports results, support and golden."""

from sim.report.page import DATA, Section, of_runs, section, write

__all__ = ["DATA", "Section", "of_runs", "section", "write"]
