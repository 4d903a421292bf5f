"""Files are written whole or not at all."""

import pytest

from golden.support.files import atomic_file, write_text


def test_a_file_is_whole_or_not_there(tmp_path):
    path = tmp_path / "summary.json"
    with pytest.raises(UnicodeEncodeError):
        write_text(path, "\ud800")
    assert not list(tmp_path.iterdir())
    write_text(path, "old")
    with pytest.raises(KeyboardInterrupt), atomic_file(path) as file:
        file.write(b"new")
        file.flush()
        assert path.read_text() == "old"
        raise KeyboardInterrupt
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]
    write_text(path, "new")
    assert path.read_text() == "new" and list(tmp_path.iterdir()) == [path]


def test_two_may_write_the_same_file_at_a_time(tmp_path):
    """The file of whoever ends last is left, whole."""
    path = tmp_path / "constraints.lpf"
    with atomic_file(path) as file:
        file.write(b"last")
        write_text(path, "first")
        assert path.read_text() == "first"
    assert path.read_text() == "last" and list(tmp_path.iterdir()) == [path]
