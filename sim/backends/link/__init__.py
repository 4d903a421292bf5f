"""The host's side of the link: a circuit on a board, or a served one, behind any pyserial URL."""
