"""Folders that results are written to, marked so that files of others are never overwritten by accident."""

from __future__ import annotations

from pathlib import Path

from golden.support.errors import InputError

MARK = ".rheogate"  # a file of this name tells that a folder was made here and may be written again


def claim(path, force: bool = False) -> Path:
    """Make the folder, or take one made here earlier. Files in it are replaced one by one, none is removed.

    Raises `InputError` for a folder with other contents, unless ``force``, and where nothing can be written.
    """
    path = Path(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
        if any(path.iterdir()) and not (path / MARK).exists() and not force:
            raise InputError(
                f"--out must be a new folder or one of earlier results, not {path}, which holds other "
                "files: choose another, or add --force to write into it all the same"
            )
        (path / MARK).write_text("Results of `python -m sim`, which may write here again.\n")
    except FileExistsError:
        raise InputError(f"--out must be a folder, not the file {path}") from None
    except OSError as error:
        raise InputError(f"--out must be a folder that can be written, not {path}: {error.strerror}") from None
    return path
