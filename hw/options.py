"""The options that choose a circuit, and the parameters they stand for."""

import argparse
import re

from golden.datapath.formats import Formats
from golden.support.errors import InputError
from hw.families.registry import family_names
from hw.parameters import Parameters
from hw.sizes import SIZES, WORDS, sizes_of, words_of


def whole(text: str) -> int:
    """Return the whole number that an option has; for argparse's ``type``."""
    if not re.fullmatch(r"-?[0-9]+", text):
        raise argparse.ArgumentTypeError(f"must be a whole number, not {text!r}")
    return int(text)


def add_sizes(command) -> None:
    """Add the options for sizes that replace the board's; None if not given."""
    for size in SIZES.values():
        text = f"{size.meaning}, {size.choice} (the board's)"
        command.add_argument(f"--{size.name}", type=whole, metavar=size.letter, help=text)


def add_circuit(command) -> None:
    """Add the options for a circuit's sizes, word lengths and family."""
    for size in SIZES.values():
        text = f"{size.meaning}, {size.choice} ({size.default})"
        command.add_argument(f"--{size.name}", type=whole, default=size.default, metavar=size.letter, help=text)
    for name, default in words_of(Formats()).items():
        text = f"{WORDS[name]} ({default})"
        command.add_argument(f"--{name}", type=whole, default=default, metavar="BITS", help=text)
    families, default = " or ".join(family_names()), Parameters.family
    text = f"devices whose hard blocks it takes, {families} ({default})"
    command.add_argument("--family", default=default, metavar="NAME", help=text)


def parameters(args) -> Parameters:
    """Return the parameters that the options choose. Raises `InputError` naming the option for one that can't be."""
    try:
        return Parameters(**sizes_of(args), formats=Formats(**words_of(args)), family=args.family)
    except ValueError as error:
        raise InputError(f"--{error}") from None
