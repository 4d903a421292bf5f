"""The commands of ``python -m golden``, one a module: ``HELP``, ``add_options(command)`` and ``run(args)``.

May import everything else of golden, the slow parts only when the command runs."""
