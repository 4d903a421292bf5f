"""Errors between host and circuit, each with a name of its own."""

from golden.support.errors import InputError


class LinkError(InputError):
    """The circuit can't be reached, or isn't one that this host can talk to."""


class LineBroken(LinkError):
    """The port can't be opened, or went away: an unplugged cable."""


class NoAnswer(LinkError):
    """Nothing that makes sense comes back."""


class OtherCircuit(LinkError):
    """The circuit speaks another version, or is too small."""


class CommandRefused(LinkError):
    """The circuit did not do what it was told."""
