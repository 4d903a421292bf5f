"""Errors, command lines and files: what every program of this project shares.

May import only the standard library; golden, hw and sim may import it.
"""
