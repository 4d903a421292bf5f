"""``python -m sim serve``: the simulated circuit behind its serial link."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from sim.backends import rtl
from sim.support.arguments import port_number

HELP = "the simulated circuit behind its serial link, on a loopback socket"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument(
        "--port", type=port_number, default=0, metavar="PORT", help="of this machine (one that is free)"
    )
    for size in rtl.SIZE_OPTIONS:
        size.add_to(command)


def run(args: Namespace) -> int:
    """Serve the circuit until it is interrupted."""
    from sim.backends.link import serve as service
    from sim.backends.link.served import BAUD, CLOCK_HZ, SerialCircuit

    parameters = rtl.RtlBackend(args.lanes or rtl.LANES, args.updates or rtl.UPDATES).parameters
    server = service.listener(args.port)
    circuit = SerialCircuit(parameters, clock_hz=CLOCK_HZ, baud=BAUD, folder=rtl.BUILD)
    print(f"serving on socket://{service.HOST}:{server.getsockname()[1]} until it is interrupted", flush=True)
    try:
        service.serve(server, circuit)
    except KeyboardInterrupt:
        return 0
    finally:
        circuit.close()
        server.close()
    return 0
