"""The project's pages and their blocks: files to write, commands to run, and what they print."""

import re
import shlex
import subprocess
from dataclasses import dataclass

import pytest

from environment import ROOT
from golden import __main__ as golden
from hw import __main__ as hw
from sim import __main__ as sim

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMANDS = {"golden": golden.main, "hw": hw.main, "sim": sim.main}
PARSERS = {"golden": golden.parser, "hw": hw.parser, "sim": sim.parser}
NUMBER = r"\d+(?:\.\d+)?(?:e[-+]?\d+)?"


@dataclass(frozen=True)
class Block:
    """A fenced block: its ``language`` and, after it, the ``name`` of the file that it shows."""

    language: str
    name: str
    text: str


def blocks(text: str) -> list[Block]:
    """Return all blocks of a Markdown text."""
    fenced = re.findall(r"^```(\w*)(?: (\S+))?\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [Block(*block) for block in fenced]


def commands(path) -> list[str]:
    """Return the commands in a page's ``sh`` blocks that are our own, from the package's name on."""
    shell = "".join(block.text for block in blocks(path.read_text()) if block.language == "sh")
    return re.findall(r"^\.venv/bin/python -m (.*)$", shell, re.MULTILINE)


def targets() -> set[str]:
    """Return the targets of the Makefile."""
    return set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))


class Reader:
    """Somebody who does what a document says, in the current folder, and compares what is printed.

    Files are written, commands run, Python is entered into one session. A ``text`` block after either is what it
    prints: the same words, and numbers within a fifth, seconds excepted. A text that begins with "error: " stands for
    an exit code other than 0.
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
                raise AssertionError(f"a block must be of toml, sh, python or text, not {block.language!r}")

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
    """Return the text without its numbers, with runs of spaces, as tables have them, made one."""
    return re.sub(" +", " ", re.sub(NUMBER, "#", text)).strip()


def numbers(text: str) -> list[float]:
    """Return all numbers but the seconds that something took, in a run's line or in a table."""
    text = re.sub(rf" in {NUMBER} s,| {NUMBER} +passes$", "", text, flags=re.MULTILINE)
    return [float(number) for number in re.findall(NUMBER, text)]
