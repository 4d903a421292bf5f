"""The page of a comparison: shapes, differences and numbers of every scene, in a folder that opens from disk."""

from sim.report.page import Section, section, write

__all__ = ["Section", "section", "write"]
