"""The description of a circuit (`hw.link.description`) as a C header, a page and JSON."""

from __future__ import annotations

from pathlib import Path

from golden.support.errors import InputError
from golden.support.files import write_text
from hw.link.description import description, dump, key
from hw.parameters import Parameters
from hw.sizes import sizes_of, words_of

HEADER, PAGE, DATA = "rheogate_map.h", "rheogate_map.md", "rheogate_map.json"


def write(p: Parameters, folder: Path) -> None:
    """Write `HEADER`, `PAGE` and `DATA` into the folder. Raises `InputError` if it can't be written."""
    about = description(p)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_text(folder / HEADER, header(p, about))
        write_text(folder / PAGE, page(p, about))
        write_text(folder / DATA, dump({"key": key(p).hex(), **about}))
    except FileExistsError:
        raise InputError(f"--out must be a folder, not the file {folder}") from None
    except OSError as error:
        raise InputError(f"--out must be a folder that can be written, not {folder}: {error.strerror}") from None


def header(p: Parameters, about: dict) -> str:
    """Return a C header with the map's constants and an address macro."""
    link = about["link"]
    constants = [("KEY", "{" + ", ".join(f"0x{byte:02x}" for byte in key(p)) + "}")]
    constants += [(name, size) for name, size in _sizes(p)]
    constants += [("MAP_VERSION", about["map_version"]), ("LINK_VERSION", link["version"])]
    constants += [("ITEM_BYTES", link["item_bytes"]), ("GREETING_BYTES", link["greeting_bytes"])]
    for field in about["address"]:
        constants += [(f"{field['name']}_low", field["low"]), (f"{field['name']}_bits", field["bits"])]
    for region in about["regions"]:
        constants.append((f"region_{region['name']}", region["number"]))
        constants.append((f"{region['name']}_depth", region["depth"]))
        for word in region["words"]:
            constants.append((f"{region['name']}_{word['name']}", word["number"]))
            for field in word["fields"]:
                name = f"{region['name']}_{word['name']}_{field['name']}"
                constants += [(f"{name}_low", field["low"]), (f"{name}_bits", field["bits"])]
    constants.append(("region_link", link["region"]))
    for group, entries, number in (
        ("control", about["registers"], "index"),
        ("link", link["registers"], "index"),
        ("fault", about["faults"], "bit"),
        ("operation", link["operations"], "number"),
        ("kind", link["kinds"], "number"),
        ("status", link["statuses"], "number"),
        ("identity", link["identity"], "item"),
    ):
        constants += [(f"{group}_{entry['name']}", entry[number]) for entry in entries]
    constants += [(f"head_{field['name']}_low", field["low"]) for field in link["head"]]
    constants.append(("status_busy", link["busy"]))
    lines = [f"#define {_name(name)} {value}" for name, value in constants]
    return "\n".join(
        [
            "/* The memory map and the link of a Rheogate circuit. Written by `python -m hw map`. */",
            "#ifndef RHEOGATE_MAP_H",
            "#define RHEOGATE_MAP_H",
            "",
            *lines,
            "",
            "#define RHEOGATE_ADDRESS(region, word, index, lane) \\",
            "    ((uint32_t)(region) << RHEOGATE_REGION_LOW | (uint32_t)(lane) << RHEOGATE_LANE_LOW \\",
            "     | (uint32_t)(word) << RHEOGATE_WORD_LOW | (uint32_t)(index))",
            "",
            "#endif",
            "",
        ]
    )


def page(p: Parameters, about: dict) -> str:
    """Return the same contents as Markdown tables."""
    link = about["link"]
    sizes = ", ".join(f"{count} {name}" for name, count in _sizes(p))
    parts = [f"# Memory map and link\n\nFor a circuit with {sizes}; key `{key(p).hex()}`."]
    parts += [_table("Address", about["address"], ("name", "low", "bits"))]
    for region in about["regions"]:
        rows = [
            {"word": word["number"], "name": word["name"], "fields": _fields(word["fields"])}
            for word in region["words"]
        ]
        parts.append(
            _table(
                f"Region {region['number']}, {region['name']}: depth {region['depth']}, {region['lanes']} lanes",
                rows,
                ("word", "name", "fields"),
            )
        )
    for title, entries, columns in (
        ("Control registers", about["registers"], ("index", "name", "meaning")),
        (f"Registers of the link, region {link['region']}", link["registers"], ("index", "name", "meaning")),
        ("Faults", about["faults"], ("bit", "name")),
        ("Operations", link["operations"], ("number", "name", "meaning")),
        ("Segments", link["kinds"], ("number", "name", "meaning")),
        ("A segment's head", link["head"], ("name", "low", "bits")),
        (
            f"Statuses, lower four bits; {link['busy']:#x}: a run is under way",
            link["statuses"],
            ("number", "name", "meaning"),
        ),
        ("Identity: the items after the number that is given back", link["identity"], ("item", "name", "meaning")),
    ):
        parts.append(_table(title, entries, columns))
    return "\n\n".join(parts) + "\n"


def _sizes(p: Parameters):
    return [*sizes_of(p).items(), *words_of(p.formats).items()]


def _name(name: str) -> str:
    return "RHEOGATE_" + name.upper().replace(" ", "_").replace("-", "_")


def _fields(fields) -> str:
    return ", ".join(f"{field['name']} ({field['low']} to {field['low'] + field['bits'] - 1})" for field in fields)


def _table(title, entries, columns) -> str:
    rows = [f"| {' | '.join(str(entry[column]) for column in columns)} |" for entry in entries]
    return "\n".join([f"## {title}", "", f"| {' | '.join(columns)} |", "|---" * len(columns) + "|", *rows])
