"""``python -m golden mesh``: look at a mesh file, or make a mesh of a kind."""

from __future__ import annotations

import json
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from pathlib import Path

from msgspec.structs import fields

from golden.scene import schema
from golden.support.command import status_line
from golden.support.errors import InputError

HELP = "look at a mesh, or make one"

MADE = {tag: [field.name for field in fields(kind)] for tag, kind in schema.KINDS.items() if tag != "file"}
"""Kinds of mesh that are made instead of read, and their options."""
OPTIONS = {
    "outer": (float, "M", "of a ring: radius (m)"),
    "inner": (float, "M", "of a ring: radius of its hole (m)"),
    "radius": (float, "M", "of a disc, cylinder, ball, irregular plate (m)"),
    "height": (float, "M", "of a cylinder (m)"),
    "size": (float, "M", "of a beam, rectangle, box: along each axis (m)"),
    "nodes": (int, "N", "of a rectangle, box: along each axis"),
    "tetrahedra": (int, "N", "of a box: in each cell of the grid, 5 or 6 (5)"),
    "edge": (float, "M", "about how long edges are (m)"),
    "seed": (int, "N", "another one makes another irregular mesh (0)"),
    "scale": (float, "M", "of a file: its unit (1)"),
}
WORDS = {float: "a number", int: "a whole number"}


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument(
        "what", metavar="FILE|KIND", help=f"a mesh file (Gmsh, VTK, VTU, OBJ, PLY), or one of {', '.join(MADE)}"
    )
    for name, (kind, letter, meaning) in OPTIONS.items():
        several = {"nargs": "+"} if name in ("size", "nodes") else {}
        command.add_argument(f"--{name}", type=_number(kind), metavar=letter, help=meaning, **several)
    command.add_argument("--scene", metavar="SCENE", help="a scene file: stable steps of its materials on this mesh")
    command.add_argument("--json", action="store_true", help="the figures as JSON")
    command.add_argument("--out", metavar="FILE", help="write the mesh: .vtu, .vtk or .msh (Gmsh)")
    command.add_argument("--force", action="store_true", help="write FILE even if it is there")


def _number(kind):
    def read(text: str):
        try:
            return kind(text)
        except ValueError:
            raise ArgumentTypeError(f"must be {WORDS[kind]}, not {text!r}") from None

    return read


def run(args: Namespace) -> int:
    """Print the figures of the mesh, and write it to a file if one is asked for."""
    from golden.mesh import files as meshfile
    from golden.scene import inspection  # SciPy takes its time
    from golden.scene import load as scene
    from golden.scene.meshes import build_mesh

    table, out = _table(args), args.out and _writable(Path(args.out), args.force)
    materials_from = scene.load(args.scene) if args.scene else None
    with status_line(f"{args.what} ..."):
        try:
            made = build_mesh(table, Path())
        except InputError as error:
            raise InputError(f"--{error}" if args.what in MADE else f"{args.what}: {error}") from None
        found = inspection.inspect(made, materials_from)
    if out:
        try:
            meshfile.write(out, made.points, [made.cells])
        except OSError as error:
            raise InputError(f"--out must be a file that can be written, not {out}: {error.strerror}") from None
    print(json.dumps(found, indent=1) if args.json else "\n".join(inspection.report_lines(args.what, found)))
    return 0


def _table(args) -> schema.Mesh:
    """Return the table of a scene file for the mesh that the arguments ask for."""
    known = MADE.get(args.what, ["scale"])
    given = {name: value for name in OPTIONS if (value := vars(args)[name]) is not None}
    what = f"a {args.what}" if args.what in MADE else "a file"
    if strange := given.keys() - set(known):
        raise InputError(
            f"--{min(strange)} must not be given with {what}, which has {', '.join(f'--{name}' for name in known)}"
        )
    kind = {"kind": args.what} if args.what in MADE else {"kind": "file", "file": args.what}
    try:
        return schema.convert(kind | given, schema.KINDS[kind["kind"]])
    except InputError as error:
        raise InputError(f"--{error}") from None


def _writable(path: Path, force: bool) -> Path:
    """Return the file to write. Raises `InputError` if it can't be written, before anything is computed for it."""
    from golden.mesh.files import FORMATS

    if path.suffix not in FORMATS:
        raise InputError(f"--out must end in {', '.join(FORMATS)}, not {path.name!r}")
    if not path.parent.is_dir():
        raise InputError(f"--out must be in a folder that is there, not {path.parent}")
    if path.is_dir() or (path.exists() and not force):
        raise InputError(
            f"--out must be a new file, not {path}, which is there: choose another"
            f"{'' if path.is_dir() else ', or add --force to replace it'}"
        )
    return path
