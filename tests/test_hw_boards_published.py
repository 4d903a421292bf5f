"""Published timing and builds: the tables, and that each result says of which version it is."""

import hashlib
import re

import msgspec
import pytest

from hw.boards import board as boards
from hw.boards import flow, tables
from hw.boards.project import version
from hw.boards.result import Build, Smallest, Timing, published, read, write

BUILDS, TIMINGS = published(Build), published(Timing)


def test_files_are_results_of_the_boards_own_circuits():
    for results, least_seeds in ((TIMINGS, 3), (BUILDS, 0)):
        for name, result in results.items():
            assert result.board == name and result.circuit == boards.load(name).circuit
            assert len(result.seeds) == len(result.fmax_mhz) >= least_seeds
            assert re.fullmatch(r"\d+\.\d+\.\d+(\.dev\d+)?", result.version)
    assert {path.stem for path in Timing.PUBLISHED.iterdir()} == {*TIMINGS, "smallest"}
    assert {path.stem for path in Build.PUBLISHED.iterdir()} == BUILDS.keys()
    assert read(Timing.PUBLISHED / "smallest.json", Smallest).board in boards.timed()


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_the_table_of_timing(tmp_path):
    timing = msgspec.structs.replace(TIMINGS["ulx3s-85f"], version="9.8.7", fmax_min=101.5)
    write(tmp_path / "ulx3s-85f.json", timing)
    text = tables.markdown(boards.timed(), published(Timing, tmp_path), tables.TIMING)
    header, rule, small, large = text.splitlines()
    assert set(rule) == {"|", "-"} and header.count("|") == rule.count("|") == small.count("|") == large.count("|")
    row = dict(zip(cells(header), cells(large), strict=True))
    assert (row["board"], row["lanes"], row["Fmax, lowest"]) == ("ulx3s-85f", "4", "101.5 MHz")
    assert row["of version"] == "9.8.7"
    assert row["LUT"] == f"{timing.resources.lut} ({timing.resources.lut / 83640:.0%})"
    assert dict(zip(cells(header), cells(small), strict=True))["of version"] == "not timed yet"


def test_the_table_of_builds(tmp_path):
    build = msgspec.structs.replace(BUILDS["ulx3s-85f"], version="9.8.7", clock_mhz=100.0, fmax_mhz=[104.0])
    write(tmp_path / "ulx3s-85f.json", build)
    text = tables.markdown(boards.names(), published(Build, tmp_path), tables.BUILDS)
    header, _, *rows = text.splitlines()
    arty, *_, ulx3s = (dict(zip(cells(header), cells(row), strict=True)) for row in rows)
    assert arty["published build"] == "none yet" and arty["of version"] == arty["Fmax"] == arty["LUT"] == ""
    assert (arty["device"], arty["lanes"], arty["clock"]) == ("xc7a100tcsg324-1", "4", "100 MHz")
    assert (ulx3s["clock"], ulx3s["Fmax"], ulx3s["of version"]) == ("100 MHz", "104.0 MHz", "9.8.7")
    assert (ulx3s["published build"], ulx3s["run on hardware"]) == ("built and timed", "no")


@pytest.mark.parametrize(
    ("name", "required"),
    [
        ("ulx3s-85f", "built and timed"),
        ("ulx3s-25f", "built and timed"),
        ("tang-mega-138k-pro", "built, multipliers and block RAMs not timed"),
    ],
)
def test_bitstreams_that_are_published(name, required, figure):
    build = BUILDS[name]
    state = build.state(boards.load(name))
    fmax = ", ".join(f"{mhz:.1f}" for mhz in build.fmax_mhz)
    figure(f"bitstream of {name}, clock {build.clock_mhz:g} MHz, reached {fmax} MHz", required, state)
    assert state == required


def of_this_version(results):
    """The names of the results that must be of the sources as they are."""
    return sorted(name for name, result in results.items() if result.version == version())


def test_results_of_another_version_are_of_other_verilog():
    """Only results of this version are compared with it."""
    now = {"mine": msgspec.structs.replace(BUILDS["ulx3s-85f"], version=version())}
    assert of_this_version(now) == ["mine"]
    before = {"mine": msgspec.structs.replace(BUILDS["ulx3s-85f"], version="0.0.1")}
    assert of_this_version(before) == []


@pytest.mark.campaign
@pytest.mark.parametrize("name", of_this_version(BUILDS))
def test_builds_of_this_version_are_of_its_verilog(name):
    board = boards.load(name)
    verilog, _ = flow.board_top(board, board.parameters())
    assert BUILDS[name].verilog_sha256 == hashlib.sha256(verilog.encode()).hexdigest()
