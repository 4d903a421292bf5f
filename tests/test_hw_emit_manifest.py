"""The manifest says what the circuit is: each of its tables against what the circuit is made from."""

import json

import pytest
from hw_objects import core_to_ask

from golden.datapath import records
from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY
from hw.emit import manifest
from hw.machine.host_port import LATENCY
from hw.machine.lane import latency
from hw.machine.routes import COPIED
from hw.map.control import REGISTERS
from hw.map.memory_map import Map, Region
from hw.parameters import Parameters

TEXT = "module rheogate();\nendmodule\n"
P = Parameters(lanes=3, nodes=20, edges=31, materials=5, tables=2)


@pytest.fixture(scope="module")
def core():
    return core_to_ask(P)


@pytest.fixture(scope="module")
def contents(core):
    return json.loads(manifest.dump(manifest.manifest(core, TEXT, "the key")))


@pytest.fixture
def regions(contents):
    return {region["name"]: region for region in contents["regions"]}


def test_hashes(contents):
    assert contents["key"] == "the key"
    assert contents["files"] == {"rheogate.v": {"sha256": manifest.digest(TEXT), "bytes": len(TEXT)}}
    assert contents["sha256"] == manifest.own_digest(contents)
    assert manifest.own_digest(contents | {"map_version": 99}) != contents["sha256"]


def test_parameters(contents):
    assert contents["parameters"] == {
        "lanes": 3,
        "updates": 1,
        "nodes": 20,
        "edges": 31,
        "rows": 11,
        "materials": 5,
        "tables": 2,
        "axes": 3,
        "operand": 18,
        "state": 36,
        "family": "generic",
    }


def test_ports(contents, core):
    widths = {path[0]: (str(member.flow).lower(), len(value)) for path, member, value in core.signature.flatten(core)}
    ports = {port["name"]: (port["direction"], port["bits"]) for port in contents["ports"]}
    assert ports == {"clk": ("in", 1), "rst": ("in", 1), **widths}
    assert all(port["meaning"] for port in contents["ports"])


def test_an_address_is_put_together_as_the_fields_say(contents):
    fields = {field["name"]: field for field in contents["address"]}
    (port,) = (port for port in contents["ports"] if port["name"] == "address")
    assert sum(field["bits"] for field in fields.values()) == port["bits"]
    for region in contents["regions"]:
        place = {
            "region": region["number"],
            "word": len(region["words"]) - 1,
            "index": region["depth"] - 1,
            "lane": region["lanes"] - 1,
        }
        assert all(place[name] < 1 << fields[name]["bits"] for name in place)
        address = sum(value << fields[name]["low"] for name, value in place.items())
        word, index, lane = (place[name] for name in ("word", "index", "lane"))
        assert address == Map(P).address(Region(region["number"]), word, index, lane)


def test_capacities(regions):
    sizes = {name: (region["depth"], region["lanes"]) for name, region in regions.items()}
    assert sizes == {"CONTROL": (24, 1), "NODE": (20, 1), "EDGE": (11, 3), "MATERIAL": (5, 3), "TABLE": (1024, 3)}


def test_fields_are_packed_from_the_lowest_bit(regions):
    """As `golden.numbers.record.Record.pack` does."""
    expected = {
        ("NODE", "entry"): records.node_entry(),
        ("EDGE", "entry"): records.edge_entry(),
        ("NODE", "inverse_mass"): records.inverse_mass(P.formats),
    }
    for region in regions.values():
        for word in region["words"]:
            record = expected.get((region["name"], word["name"]))
            low = 0
            for field in word["fields"]:
                assert field["low"] == low
                low += field["bits"]
                if record:
                    raw = dict.fromkeys(record, 0) | {field["name"]: 1}
                    assert record.pack(raw) == 1 << field["low"]
            assert low <= P.formats.state
            assert record is None or {field["name"] for field in word["fields"]} == set(record)


def test_words_have_the_formats_of_the_model(regions):
    f = P.formats
    formats = {
        "x": f.position,
        "v": f.velocity,
        "load": f.accumulator,
        "force": f.accumulator,
        "length": f.length,
        "ratio": f.ratio,
        **records.material(f, P.tables),
    }
    seen = set()
    for name in ("NODE", "EDGE", "MATERIAL"):
        for word in regions[name]["words"]:
            stem = word["name"].rsplit("_", 1)[0] if word["name"][-1] in AXES and name == "NODE" else word["name"]
            if stem in formats:
                (field,) = word["fields"]
                q = formats[stem]
                assert (field["bits"], field["signed"], field["fraction_bits"]) == (q.width, q.signed, q.frac_bits)
                seen.add(stem)
    assert seen == set(formats)
    table = [field["name"] for word in regions["TABLE"]["words"] for field in word["fields"]]
    assert table == list(records.damper_word(f))


def test_registers(contents):
    registers = contents["registers"]
    assert [(r["index"], r["name"], r["meaning"]) for r in registers] == [
        (c, c.name, row.meaning) for c, row in REGISTERS.items()
    ]
    writable = {r["name"] for r in registers if not r["read_only"]}
    assert writable == {"FAULTS", "REFUSED", "ROW_COUNT", "NODE_COUNT", "VELOCITY_SHIFT", "RUN", "STOP"}


def test_only_forces_are_read_only(regions):
    words = {(name, word["name"]) for name, region in regions.items() for word in region["words"] if word["read_only"]}
    assert words == {("NODE", f"force_{axis}") for axis in AXES}


def test_faults_and_formats(contents, core):
    assert [fault["name"] for fault in contents["faults"]] == core.faults
    assert [fault["bit"] for fault in contents["faults"]] == list(range(len(core.faults)))
    named = {q["name"]: (q["bits"], q["signed"], q["fraction_bits"], q["unit"]) for q in contents["formats"]}
    assert named == {q.name: (q.width, q.signed, q.frac_bits, q.unit) for q in P.formats.all()}
    assert named.keys() >= set(core.faults) - {"edge length"}


def test_latencies(contents, core):
    cycles = {(item["of"], item["from_to"]): item["cycles"] for item in contents["latencies"]}
    assert cycles["host port", "request to answer"] == LATENCY
    assert cycles["block RAM", "address to word"] == READ_LATENCY
    assert cycles["edge", "issue to the sums that contain its force"] == latency(core.datapath)
    assert cycles["node", "issue to its new state in the lanes' memories"] == core.node_datapath.latency + COPIED
    for name, schedule in (("edge", core.datapath.schedule), ("node", core.node_datapath.schedule)):
        pipeline = contents["pipelines"][name]
        assert pipeline["cycles"] == schedule.latency == max(item["to"] for item in pipeline["operations"])
        assert pipeline["arrival"] == schedule.arrival
        stages = [tuple(item.values()) for item in pipeline["operations"]]
        assert stages == schedule.stages()
