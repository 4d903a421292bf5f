"""The short list of boards in the README; docs/boards.md has every figure."""

from hw.boards import board as boards
from hw.boards.bitstream.result import Build


def board_list(builds: dict[str, Build]) -> str:
    """Markdown: each board with the circuit and the state of its published build, or of what its file asks for."""
    lines = ["| board | device | lanes | nodes | edges | clock | published build |", "|---|---|---|---|---|---|---|"]
    for name in boards.names():
        board, build = boards.load(name), builds.get(name)
        sizes, clock, state = board.circuit, board.clock_mhz, "none yet"
        if build is not None:
            sizes, clock, state = build, build.clock_mhz, build.state(board)
        cells = name, board.device, sizes.lanes, sizes.nodes, sizes.edges, f"{clock:g} MHz", state
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join(lines)
