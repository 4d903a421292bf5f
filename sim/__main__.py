"""The command line: ``python -m sim run SCENE ...``, ``python -m sim compare SCENE ...``, and what else helps."""

from __future__ import annotations

import argparse
import sys
from functools import partial
from math import inf, nan
from pathlib import Path

from golden.scene import load as scenes
from golden.support.command import Parser, execute
from golden.support.errors import InputError
from sim.backends import machines, waves
from sim.run import BACKENDS, LANES, UPDATES
from sim.support.errors import about


def parser() -> Parser:
    main = Parser(prog="python -m sim", description="Run scenes on float64, on integers and on the simulated circuit.")
    commands = main.add_subparsers(dest="command", required=True, metavar="COMMAND")

    one = commands.add_parser("run", help="run one scene on one backend")
    one.add_argument("scene", metavar="SCENE", help="a scene file (TOML)")
    one.add_argument(
        "--backend",
        required=True,
        choices=BACKENDS,
        help="float64, the circuit's integer model, its Verilog under Verilator, or a circuit on a board",
    )
    one.add_argument(
        "--port", metavar="URL", help="board: a serial port or any other URL of pyserial's, as socket://127.0.0.1:5000"
    )
    one.add_argument("--baud", type=whole, metavar="N", help="board: bits a second (1000000)")
    one.add_argument(
        "--waves",
        nargs="?",
        const="vcd",
        choices=waves.FORMATS,
        metavar="vcd|fst",
        help="write the waveforms of the circuit's first 5000 busy cycles as well "
        "(rtl; vcd, which is larger but needs no library)",
    )
    one.add_argument(
        "--out", required=True, metavar="DIR", help="folder for scene.npz, trajectory.npz and summary.json"
    )
    one.set_defaults(run=run)

    many = commands.add_parser("compare", help="run scenes on all backends side by side and report the differences")
    many.add_argument("scenes", nargs="+", metavar="SCENE", help="scene files (TOML)")
    many.add_argument(
        "--out", default="build/report", metavar="DIR", help="folder for compare.json and index.html (build/report)"
    )
    many.set_defaults(run=compare)

    drawn = commands.add_parser("figures", help="draw the paper's figures from runs of the circuit")
    drawn.add_argument("names", nargs="*", metavar="NAME", help="figures, as figure-6 or gravity (all)")
    drawn.add_argument(
        "--out",
        default="build/figures",
        metavar="DIR",
        help="folder for PNG, SVG and GIF of each, and figures.json (build/figures)",
    )
    drawn.add_argument(
        "--backend",
        default="fixed",
        choices=("fixed", "rtl"),
        help="the circuit's integer model, or its Verilog under Verilator: the same bits (fixed)",
    )
    drawn.set_defaults(run=figures)

    kept = commands.add_parser("export", help="write a run in a form that other programs read")
    kept.add_argument("run_folder", metavar="RUN", help="folder that `run` left")
    kept.add_argument(
        "--vtu", action="store_true", required=True, help="for ParaView: run.pvd and a file for each frame"
    )
    kept.add_argument("--out", metavar="DIR", help="folder to write to (RUN/vtu)")
    kept.set_defaults(run=export)

    page = commands.add_parser("report", help="the page of runs that there are already")
    page.add_argument(
        "runs",
        nargs="+",
        metavar="RUN",
        help="folders of `run`: those of the same scene go together; float64, if it isn't there, is run",
    )
    page.add_argument(
        "--out", default="build/report", metavar="DIR", help="folder for compare.json and index.html (build/report)"
    )
    page.set_defaults(run=report)

    board = commands.add_parser("serve", help="the simulated circuit behind its serial link, on a loopback socket")
    board.add_argument("--port", type=port_number, default=0, metavar="PORT", help="of this machine (one that is free)")
    board.set_defaults(run=serve)

    speed = commands.add_parser("bench", help="time the circuit's step and that of software on this machine")
    speed.add_argument("--meshes", nargs="+", metavar="MESH", help="nodes along each axis, as 9x9 or 5x5x5")
    speed.add_argument("--steps", type=whole, default=10_000, metavar="N", help="steps of the software to time (10000)")
    speed.add_argument("--clock", type=megahertz, metavar="MHZ", help="the circuit's clock (timed: ULX3S-85F)")
    speed.add_argument(
        "--out", default="build/bench.json", metavar="FILE", help="file for the figures (build/bench.json)"
    )
    speed.set_defaults(run=bench)

    for command, only in ((one, "rtl; "), (many, ""), (board, "")):
        command.add_argument("--lanes", type=whole, metavar="P", help=f"edge processors of the circuit ({only}{LANES})")
        command.add_argument(
            "--updates",
            type=whole,
            metavar="M",
            help=f"nodes that the circuit updates in a cycle, 1 or 2 ({only}{UPDATES})",
        )
    for command, what in (
        (one, "summary.json instead of a line"),
        (many, "compare.json instead of a table"),
        (page, "compare.json instead of a table"),
        (drawn, "figures.json instead of a table"),
        (speed, "FILE instead of tables"),
    ):
        command.add_argument("--json", action="store_true", help=f"print the contents of {what}")
    for command in (one, many, page, drawn, kept):
        command.add_argument("--force", action="store_true", help="write into DIR even if other files are there")
    return main


def whole(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number of at least 1, not {text!r}")
    return int(text)


def port_number(text: str) -> int:
    if not text.isdecimal() or int(text) >= 1 << 16:
        raise argparse.ArgumentTypeError(f"must be a whole number from 0 to {(1 << 16) - 1}, not {text!r}")
    return int(text)


def megahertz(text: str) -> float:
    try:
        clock = float(text)
    except ValueError:
        clock = nan
    if not 0 < clock < inf:
        raise argparse.ArgumentTypeError(f"must be a finite number above 0, not {text!r}")
    return clock


def run(args) -> int:
    from sim.results import store
    from sim.run import run
    from sim.support import folder, terminal

    only = dict.fromkeys(("lanes", "updates", "waves"), "rtl") | dict.fromkeys(("port", "baud"), "board")
    for option, backend in only.items():
        if getattr(args, option) and args.backend != backend:
            raise InputError(f"--{option} must go with --backend {backend}, not {args.backend}")
    if args.backend == "board" and not args.port:
        raise InputError("--port must say where the board is (make doctor lists the ports of this machine)")
    if args.waves:
        waves.check(Path(f"waves.{args.waves}"))
    wanted = _circuit(args)[1] if args.backend == "rtl" else {}
    scene = scenes.load(args.scene)
    out = folder.claim(args.out, args.force)
    for suffix in waves.FORMATS:  # of an earlier run
        (out / f"waves.{suffix}").unlink(missing_ok=True)
    if args.backend == "board":
        from sim.backends.link.board import BAUD, Board

        wanted["link"] = Board.at(args.port, args.baud or BAUD)
    with about(scene), terminal.steps(scene, args.backend) as shown:
        result = run(scene, args.backend, **wanted, waves=args.waves and out / f"waves.{args.waves}", progress=shown)
    store.save(scene, result, out)
    if not _printed(args, out / store.SUMMARY):
        print(
            f"{scene.name}: {scene.steps} steps on {args.backend} in {result.seconds:.1f} s, "
            f"{len(scene.frames)} frames in {out / store.TRAJECTORY}"
        )
    if result.faults:
        print(f"error: saturated: {', '.join(result.faults)}", file=sys.stderr)
    return 1 if result.faults else 0


def _printed(args, path: Path) -> bool:
    """Whether the file was to be printed, and is."""
    if args.json:
        print(path.read_text(encoding="utf-8"), end="")
    return args.json


def _circuit(args):
    """The circuit's parameters, and what was asked of them. Raises `InputError` if it can't have them."""
    wanted = {"lanes": args.lanes or LANES, "updates": args.updates or UPDATES}
    return machines.parameters(**wanted), wanted


def compare(args) -> int:
    from sim import report
    from sim.encode import limits
    from sim.results.compare import STAGES
    from sim.support import batch, folder, terminal

    parameters, wanted = _circuit(args)
    loaded = [scenes.load(path) for path in args.scenes]
    names = [scene.name for scene in loaded]
    if twice := {name for name in names if names.count(name) > 1}:
        raise InputError(f"scenes must have names of their own, not {min(twice)!r} twice")
    for scene in loaded:
        with about(scene):
            machines.check_room(limits.load(scene).image, parameters)
    out = folder.claim(args.out, args.force)
    with terminal.progress(loaded, STAGES) as shown:
        sections = batch.over_scenes(partial(report.section, **wanted), loaded, shown)
    return _reported(args, sections, out)


def report(args) -> int:
    from sim import report
    from sim.results import stored
    from sim.results.compare import STAGES
    from sim.support import batch, folder, terminal

    groups = stored.grouped(args.runs)
    out = folder.claim(args.out, args.force)
    loaded, folders = [scene for scene, _ in groups], {scene.name: runs for scene, runs in groups}
    with terminal.progress(loaded, (STAGES[0], STAGES[-1])) as shown:
        sections = batch.over_scenes(partial(report.of_runs, folders=folders), loaded, shown)
    return _reported(args, sections, out)


def _reported(args, sections, out: Path) -> int:
    """Write the page and print its table. 1 if a scene does not pass, and why."""
    from sim import report
    from sim.results.compare import shortcomings
    from sim.support import terminal

    entries = [section.entry for section in sections]
    report.write(sections, out)
    if not _printed(args, out / report.DATA):
        terminal.print_table(entries)
    wrong = [(entry["scene"], reason) for entry in entries for reason in shortcomings(entry)]
    for name, reason in wrong:
        print(f"error: {name}: {reason}", file=sys.stderr)
    return 1 if wrong else 0


def figures(args) -> int:
    from sim.figures import catalogue, make, table
    from sim.support import folder, terminal

    names = catalogue.chosen(args.names)
    out = folder.claim(args.out, args.force)
    entries = make.earlier(out)
    loaded = make.scenes(names)
    with terminal.progress(loaded, ("float", args.backend)) as shown:
        pairs = make.compute(loaded, args.backend, shown)
    with terminal.bars([(name, make.PICTURES) for name in names]) as shown:
        drawn = {
            name: make.draw(name, pairs, out, shown and partial(shown, number)) for number, name in enumerate(names)
        }
    make.save(entries | drawn, out)
    if not _printed(args, out / make.DATA):
        table.print_readings(drawn)
        print(f"\nPNG, SVG and GIF of each figure are in {out}, the numbers in {out / make.DATA}")
    wrong = make.shortcomings(names, pairs)
    for reason in wrong:
        print(f"error: {reason}", file=sys.stderr)
    return 1 if wrong else 0


def export(args) -> int:
    from sim.results import export, store
    from sim.support import folder, terminal

    scene, _, trajectory = store.load(args.run_folder)
    out = folder.claim(args.out or Path(args.run_folder) / "vtu", args.force)
    *frames, collection = export.vtu(scene, trajectory, out, terminal.shown("frames"))
    print(f"{scene.name}: {len(frames)} frames in {collection}")
    return 0


def serve(args) -> int:
    from sim.backends.link import serve as service
    from sim.backends.link.served import BAUD, CLOCK_HZ, SerialCircuit

    parameters, _ = _circuit(args)
    server = service.listener(args.port)
    circuit = SerialCircuit(parameters, clock_hz=CLOCK_HZ, baud=BAUD, folder=machines.BUILD)
    print(f"serving on socket://{service.HOST}:{server.getsockname()[1]} until it is interrupted", flush=True)
    try:
        service.serve(server, circuit)
    except KeyboardInterrupt:
        return 0
    finally:
        circuit.close()
        server.close()
    return 0


def bench(args) -> int:
    from sim.results import cycles
    from sim.results import step_time as steptime
    from sim.speed import bench, table, timing  # Numba is slow to load
    from sim.speed.meshes import MESHES

    out = bench.claim(Path(args.out))
    with table.progress() as shown:

        def software(scene):
            return timing.software(scene, args.steps, lambda name: shown(f"{scene.name}: {timing.SOFTWARE[name]}"))

        clock = args.clock or steptime.clock(bench.BOARD)
        entries = bench.bench(args.meshes or MESHES, cycles.cycles_per_step, software, clock=clock)
    bench.save(entries, out)
    if not _printed(args, out):
        table.print_tables(entries)
    return 0


def main(arguments=None) -> int:
    """Exit code: that of `golden.support.command.execute`, or 1 when models disagree or something saturated."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
