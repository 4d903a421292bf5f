"""The host's side of the link: a circuit on a board, or a simulated one on a socket.

Backends and commands of `sim` may import it.
"""
