"""The files for drivers in other languages: the header compiles, and says what the Python table says."""

import json
import subprocess

import pytest

from hw.__main__ import main
from hw.emit import pages
from hw.link.description import description, key
from hw.link.protocol import HEAD, Operation, Status
from hw.link.registers import LINK, Link
from hw.map.control import REGISTERS, Control
from hw.map.memory_map import Map, Region, join
from hw.parameters import Parameters

P = Parameters(lanes=3, nodes=20, edges=31, materials=5, tables=2)


def test_the_header_compiles_and_gives_the_same_numbers(tmp_path):
    pages.write(P, tmp_path)
    memory = Map(P)
    expected = {
        f"RHEOGATE_ADDRESS(RHEOGATE_REGION_{region.name}, {word}, {memory.depth(region) - 1}, 0)": join(
            region, word, memory.depth(region) - 1, 0
        )
        for region in Region
        for word in range(len(memory.words(region)))
    }
    expected |= {f"RHEOGATE_CONTROL_{register.name}": register for register in Control}
    expected |= {f"RHEOGATE_LINK_{register.name}": register for register in Link}
    expected |= {f"RHEOGATE_OPERATION_{operation.name}": operation for operation in Operation}
    expected |= {f"RHEOGATE_STATUS_{status.name}": status for status in Status}
    expected |= {"RHEOGATE_REGION_LINK": LINK, "RHEOGATE_HEAD_COUNT_LOW": sum(q.width for q in HEAD.values()) - 8}
    expected |= {"RHEOGATE_LANES": 3, "RHEOGATE_STATE": 36, "RHEOGATE_NODE_X_Y": 1}
    prints = "\n".join(f'    printf("%lu\\n", (unsigned long)({expression}));' for expression in expected)
    program = tmp_path / "map.cpp"
    program.write_text(
        f'#include <cstdint>\n#include <cstdio>\n#include "{pages.HEADER}"\n'
        f"const uint8_t the_key[] = RHEOGATE_KEY;\n"
        f'int main() {{\n{prints}\n    for (int byte : the_key) printf("%02x", byte);\n}}\n'
    )
    subprocess.run(["c++", "-Wall", "-Werror", "-o", tmp_path / "map", program], check=True)
    *numbers, last = subprocess.run([tmp_path / "map"], capture_output=True, text=True, check=True).stdout.split()
    assert dict(zip(expected, map(int, numbers), strict=True)) == expected and last == key(P).hex()


def test_the_page_and_the_data_say_everything(tmp_path):
    pages.write(P, tmp_path)
    page = (tmp_path / pages.PAGE).read_text()
    assert all(f"| {r.value} | {r.name} | {row.meaning} |" in page for r, row in REGISTERS.items())
    assert all(word in page for region in Region for word in Map(P).words(region))
    assert json.loads((tmp_path / pages.DATA).read_text()) == {"key": key(P).hex(), **description(P)}


def test_the_command(tmp_path, capsys):
    assert main(["map", "--lanes", "2", "--out", str(tmp_path / "map")]) == 0
    assert {path.name for path in (tmp_path / "map").iterdir()} == {pages.HEADER, pages.PAGE, pages.DATA}
    assert f"{tmp_path / 'map'}: " in capsys.readouterr().out


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["--lanes", "9"], "--lanes must be a whole number from 1 to 8, not 9"),
        (["--out", "{file}"], "--out must be a folder, not the file {file}"),
        (["--out", "{file}/map"], "--out must be a folder that can be written, not {file}/map: Not a directory"),
    ],
)
def test_mistakes(arguments, message, tmp_path, capsys):
    file = tmp_path / "file"
    file.write_text("")
    assert main(["map", *(word.format(file=file) for word in arguments)]) == 2
    assert capsys.readouterr().err == f"error: {message.format(file=file)}\n"
