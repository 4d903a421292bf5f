"""Schema of a scene file: its tables, keys and types, each checked alone."""

from __future__ import annotations

import re
from typing import Annotated, Any, get_args

import msgspec
from msgspec import Meta, Struct, inspect

from golden.scene.regions import Region
from golden.support.errors import InputError

Positive = Annotated[float, Meta(gt=0)]
Count = Annotated[int, Meta(ge=1)]
Seed = Annotated[int, Meta(ge=0)]


class Rectangle(Struct, tag_field="kind", tag="rectangle", forbid_unknown_fields=True):
    nodes: list[int]
    size: list[float]  # m


class Box(Struct, tag_field="kind", tag="box", forbid_unknown_fields=True):
    nodes: list[int]
    size: list[float]  # m
    tetrahedra: int = 5


class File(Struct, tag_field="kind", tag="file", forbid_unknown_fields=True):
    file: str  # relative to the scene file
    scale: float = 1.0  # m per unit of the file


class Disc(Struct, tag_field="kind", tag="disc", forbid_unknown_fields=True):
    radius: Positive  # m
    edge: Positive  # m: about how long edges are
    seed: Seed = 0  # another one gives another mesh


class Ring(Struct, tag_field="kind", tag="ring", forbid_unknown_fields=True):
    outer: Positive  # m: its radii
    inner: Positive
    edge: Positive
    seed: Seed = 0


class Cylinder(Struct, tag_field="kind", tag="cylinder", forbid_unknown_fields=True):
    radius: Positive  # m
    height: Positive  # m
    edge: Positive
    seed: Seed = 0


class Ball(Struct, tag_field="kind", tag="ball", forbid_unknown_fields=True):
    radius: Positive  # m
    edge: Positive
    seed: Seed = 0


class Beam(Struct, tag_field="kind", tag="beam", forbid_unknown_fields=True):
    size: list[float]  # m, of two axes or of three
    edge: Positive
    seed: Seed = 0


class Irregular(Struct, tag_field="kind", tag="irregular", forbid_unknown_fields=True):
    radius: Positive  # m
    edge: Positive
    seed: Seed = 0


Mesh = Rectangle | Box | File | Disc | Ring | Cylinder | Ball | Beam | Irregular
KINDS = {kind.__struct_config__.tag: kind for kind in get_args(Mesh)}


class Mass(Struct, forbid_unknown_fields=True):
    density: Positive | None = None  # kg/m^2 in two dimensions, kg/m^3 in three
    total: Positive | None = None  # kg


class Driven(Region, forbid_unknown_fields=True, kw_only=True):
    velocity: list[float]  # m/s


class Load(Region, forbid_unknown_fields=True, kw_only=True):
    force: list[float]  # N on each node


class Phase(Struct, forbid_unknown_fields=True):
    duration: Positive  # s
    name: str | None = None
    fixed: list[Region] = []
    driven: list[Driven] = []
    loads: list[Load] = []
    materials: dict[str, Any] = {}  # without regions: they replace those of these names


class Frames(Struct, forbid_unknown_fields=True):
    every: Count | None = None  # steps
    count: Count | None = None


class SceneFile(Struct, forbid_unknown_fields=True):
    dt: Positive  # s
    mesh: Mesh
    materials: dict[str, Any]  # their keys depend on the preset: `golden.scene.assignment`
    mass: Mass
    phases: list[Phase]
    name: str | None = None
    description: str = ""
    gravity: list[float] | None = None  # m/s^2
    frames: Frames = msgspec.field(default_factory=lambda: Frames(count=100))


def convert(document: Any, kind: type, path: str = "") -> Any:
    """Return the document, found at ``path``, as a ``kind``. Raises `InputError` naming the key that doesn't fit."""
    _refuse_infinite(document, path)
    try:
        return msgspec.convert(document, kind)
    except msgspec.ValidationError as error:
        raise InputError(_explain(str(error), document, kind, path)) from None


def unknown_key(path: str, known) -> InputError:
    """Return the error for a key that isn't one of ``known``."""
    return InputError(f"{path} must not be there: the keys known here are {', '.join(known)}")


def _refuse_infinite(value: Any, path: str) -> None:
    """Refuse the numbers that TOML has and float64 arithmetic must not meet."""
    if isinstance(value, dict):
        for key, entry in value.items():
            _refuse_infinite(entry, _join(path, key))
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            _refuse_infinite(entry, f"{path}[{index}]")
    elif isinstance(value, (int, float)) and not -1e300 < value < 1e300:
        raise InputError(f"{path} must be a finite number, not {value:g}")


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


WORDS = {"int": "a whole number", "float": "a number", "str": "text", "array": "a list", "object": "a table"}
BOUNDS = {">": "above", ">=": "of at least"}


def _explain(message: str, document: Any, kind: type, path: str) -> str:
    """Return msgspec's message in this project's form, with the value that was found."""
    what, _, where = message.partition(" - at `$")
    node, value = inspect.type_info(kind), document
    for key, index in re.findall(r"(\w+)|\[(\d+)\]", where):
        path = _join(path, key) if key else f"{path}[{index}]"
        value = value.get(key) if key else value[int(index)]
        node = _entry(node, key, value)
    if found := re.fullmatch(r"Object missing required field `(\w+)`", what):
        return f"{_join(path, found[1])} must be given"
    if found := re.fullmatch(r"Object contains unknown field `(.*)`", what):
        known = [node.cls.__struct_config__.tag_field, *(field.name for field in node.fields)]
        return str(unknown_key(_join(path, found[1]), filter(None, known)))
    if found := re.match(r"Expected `(\w+)(?: \| null)?`(?: (>=?) (\S+))?", what):
        bound = f" {BOUNDS[found[2]]} {float(found[3]):g}" if found[2] else ""
        return f"{path} must be {WORDS[found[1]]}{bound}, not {format_value(value)}"
    return f"{path} must be one of {', '.join(KINDS)}, not {format_value(value)}"  # the one table with variants


def _entry(node: Any, key: str, value: Any) -> Any:
    """Return the type of an entry of a table or a list; among variants, the one whose tag the value has."""
    if not key:
        inner = node.item_type
    else:
        inner = next((field.type for field in node.fields if field.name == key), inspect.StrType())
    variants = getattr(inner, "types", [inner])
    said = value.get("kind") if isinstance(value, dict) else None
    return next((node for node in variants if getattr(node, "tag", None) == said), variants[0])


def format_value(value: Any) -> str:
    """Return a value as it is written in the file, or the name of its kind for a table or a list."""
    named = {dict: "a table", list: "a list", bool: str(value).lower()}
    return named.get(type(value), repr(value) if isinstance(value, str) else str(value))
