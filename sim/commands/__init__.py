"""The commands of ``python -m sim``, one a module: its name, ``HELP``, ``add_options(command)`` and ``run(args)``.

May import everything else of sim, the slow parts only when the command runs."""
