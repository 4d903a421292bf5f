"""The blocks of the project's documents: files to write, commands to run, what they print."""

import re
import shlex
import subprocess
from dataclasses import dataclass

import pytest

from environment import ROOT
from golden import __main__ as golden
from sim import __main__ as sim

COMMANDS = {"golden": golden.main, "sim": sim.main}
NUMBER = r"\d+(?:\.\d+)?(?:e[-+]?\d+)?"


@dataclass(frozen=True)
class Block:
    """A fenced block: ``language`` and, behind it, the ``name`` of the file that it is."""

    language: str
    name: str
    text: str


def blocks(text: str) -> list[Block]:
    """All blocks of a Markdown text."""
    fenced = re.findall(r"^```(\w*)(?: (\S+))?\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [Block(*block) for block in fenced]


def targets() -> set[str]:
    """What `make` can be asked for."""
    return set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))


class Reader:
    """Somebody who does what a document says, in the current folder, and looks at what is printed.

    Files are written, commands run, Python is entered into one session. ``text`` behind either is what it prints:
    the same words, and numbers within a fifth, but for seconds; "error: " means an exit code that isn't 0.
    """

    def __init__(self, capsys):
        self.capsys = capsys
        self.session = {}
        self.printed, self.codes = "", []

    def take(self, block: Block, folder) -> None:
        match block.language:
            case "toml":
                path = folder / block.name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block.text)
            case "sh":
                self.codes = [self._run(line) for line in block.text.splitlines()]
                self._read()
            case "python":
                exec(compile(block.text, "tutorial", "exec"), self.session)
                self.codes = []
                self._read()
            case "text":
                self._same(block.text)
            case _:
                raise AssertionError(f"a block of {block.language!r} is none that is run")

    def _run(self, line: str) -> int:
        first, *rest = shlex.split(line)
        if first == "make":
            assert set(rest) <= targets()
            return 0
        if first == ".venv/bin/python":
            option, module, *arguments = rest
            assert option == "-m"
            return COMMANDS[module](arguments)
        return subprocess.run(line, shell=True, check=True).returncode

    def _read(self):
        out, err = self.capsys.readouterr()
        self.printed = out + err

    def _same(self, expected: str) -> None:
        what = f"printed:\n{self.printed}\nbut the document says:\n{expected}"
        assert words(self.printed) == words(expected), what
        assert any(self.codes) == expected.startswith("error: "), what
        for one, other in zip(numbers(self.printed), numbers(expected), strict=True):
            assert one == pytest.approx(other, rel=0.2), what


def words(text: str) -> str:
    """The text without its numbers, and one space in the place of several, as tables have."""
    return re.sub(" +", " ", re.sub(NUMBER, "#", text)).strip()


def numbers(text: str) -> list[float]:
    """All numbers but the seconds that something took, of a run or in a table."""
    text = re.sub(rf" in {NUMBER} s,| {NUMBER} +passes$", "", text, flags=re.MULTILINE)
    return [float(number) for number in re.findall(NUMBER, text)]
