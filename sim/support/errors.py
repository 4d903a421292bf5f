"""Errors that name the scene that they are about."""

from contextlib import contextmanager

from golden.support.errors import InputError, InternalError


@contextmanager
def about(scene):
    """Put the scene's file in front of the messages of errors that its numbers cause."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{scene.path or scene.name}: {error}") from None
    except InternalError as error:
        raise InternalError(f"{scene.path or scene.name}: {error}") from None
