"""Gowin Arora V (GW5A)."""
