"""Errors between host and circuit."""

from golden.support.errors import InputError


class LinkError(InputError):
    """The host can't use the circuit."""


class LineBroken(LinkError):
    """The port can't be opened, or disappeared, as when a cable is unplugged."""


class NoAnswer(LinkError):
    """The circuit doesn't answer."""


class OtherCircuit(LinkError):
    """The circuit is of another version, or too small."""


class CommandRefused(LinkError):
    """The circuit refused a command."""
