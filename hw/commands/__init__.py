"""Commands of ``python -m hw``, a module each with ``add_options(parser)`` and ``run(args)``.

Only `hw.__main__` imports them; those about boards live in `hw.boards`.
"""
