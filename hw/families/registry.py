"""All families: every folder beside this file that has a ``family.py``."""

import pkgutil
from importlib import import_module

import hw.families
from hw.families.family import Family


def family_names() -> list[str]:
    """The folders' names, sorted. They are looked up at each call, so that adding a family is adding a folder."""
    return sorted(module.name for module in pkgutil.iter_modules(hw.families.__path__) if module.ispkg)


def get_family(name: str) -> Family:
    """Import a family. Raises ValueError for a name that no folder has."""
    if name not in (known := family_names()):
        raise ValueError(f"family must be {' or '.join(known)}, not {name!r}")
    return import_module(f"{hw.families.__name__}.{name}.family").FAMILY
