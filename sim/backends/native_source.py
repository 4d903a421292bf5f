"""The C++ text of the datapath's graphs, which ``native.cpp`` includes: one constant an operation, under its name."""

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import edge_graph, node_graph
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES, Graph, Operation

WIDEST = 63
"""Bits of the widest number, sign included: its rounding must fit an int64."""


def sources(fmt: Formats) -> tuple[dict[str, str], list[str]]:
    """Return the included files (text by name) and the names of the faults, in the order of the program's counters.

    Raises
    ------
    ValueError
        If a number of the datapath does not fit an int64.
    """
    edge, node = edge_graph(fmt, tables=1), node_graph(fmt, banks=1)  # the text is the same for any number of tables
    faults = sorted(_faults(edge) | _faults(node))
    material, inverse_mass = records.material(fmt, tables=1), records.inverse_mass(fmt)
    stages = [RK4.stage(s) for s in range(RK4.stages)]
    common = {"velocity_shift": "common.velocity_shift"} | {f"stage_{bit}": f"stage_{bit}[stage]" for bit in stages[0]}

    edge_places = common | _record("material", material, "edge.material") | _vector("pull", "pull")
    edge_places |= {f"edge_{name}": f"edge.{name}" for name in records.edge_state(fmt)}
    edge_places |= {f"{name}_next": f"edge.{name}" for name in ("base", "ratio", "total")}
    for end in "ij":
        edge_places |= _vector(f"{end}_x", f"{end}.x") | _vector(f"{end}_v", f"{end}.v")

    node_places = common | _record("inverse_mass", inverse_mass, "node.inverse_mass") | _vector("pull0", "node.pull")
    for name in ("load", "force", "x", *records.node_state(fmt)):
        node_places |= _vector(name, f"node.{name}") | _vector(f"{name}_next", f"node.{name}")

    constants = {"int STAGES": len(stages)}
    constants |= {"int MATERIAL_FIELDS": len(material), "int INVERSE_MASS_FIELDS": len(inverse_mass)}
    constants |= {f"Int stage_{bit}[]": f"{{{', '.join(str(s[bit]) for s in stages)}}}" for bit in stages[0]}
    files = {
        "constants.inc": "".join(f"constexpr {name} = {value};\n" for name, value in constants.items()),
        "edge.inc": _Program(edge, edge_places, faults).text,
        "node.inc": _Program(node, node_places, faults).text,
    }
    return files, faults


def _faults(graph: Graph) -> set[str]:
    rounded = {node.fmt.name for node in graph.operations if node.kind in ("round", "shift_right")}
    return rounded - {""} | {name for name, _ in graph.faults}


def _vector(name: str, place: str) -> dict[str, str]:
    return {f"{name}_{axis}": f"{place}[{number}]" for number, axis in enumerate(AXES)}


def _record(prefix: str, record: dict, place: str) -> dict[str, str]:
    return {f"{prefix}_{name}": f"{place}[{number}]" for number, name in enumerate(record)}


class _Program:
    """The C++ statements of one graph, ``text``; ``places`` has the C++ variable of each input and output."""

    def __init__(self, graph: Graph, places: dict[str, str], faults: list[str]):
        self._places, self._faults = places, faults
        lines = []
        for node in graph.operations:
            if node.kind != "read":  # a word, wider than an int64: its fields are read one by one
                _check_width(node.name, node.fmt.width, node.fmt.signed)
                lines.append(f"const Int {_name(node)} = {self._expression(node, *map(_name, node.operands))};")
        lines += [f"*{self._counter(name)} += {_name(bit)};" for name, bit in graph.faults]
        lines += [f"{places[label]} = {_name(node)};" for label, node in graph.outputs.items()]
        self.text = "".join(f"{line}\n" for line in lines)

    def _counter(self, name: str) -> str:
        return f"(common.faults + {self._faults.index(name)})" if name else "nullptr"

    def _expression(self, node: Operation, *operands: str) -> str:
        match node.kind:
            case "input":
                return self._places[node.name]
            case "const":
                return str(node.detail)
            case "sum":
                return " + ".join(_aligned(*node.operands))
            case "add" | "sub" | "less":
                return f" {OPERATORS[node.kind]} ".join(_aligned(*node.operands))
            case "mul":
                return " * ".join(operands)
            case "abs":
                return f"{operands[0]} < 0 ? -{operands[0]} : {operands[0]}"
            case "select":
                return f"{operands[0]} ? " + " : ".join(_aligned(*node.operands[1:]))
            case "scale":
                return operands[0]
            case "field":
                sign = node.fmt.signed << node.fmt.width - 1
                return f"({operands[0]} >> {node.detail} & {(1 << node.fmt.width) - 1} ^ {sign}) - {sign}"
            case "shift_left":
                return " << ".join(operands)
            case "lead":
                q = node.operands[0].fmt
                magnitudes = " | ".join(f"magnitude({x})" for x in operands)
                return f"lead({magnitudes}, {q.width - q.signed}, {node.detail})"
            case "part":
                return _table_field(node)
            case "round" | "shift_right":
                return self._rounded(node, *operands)
        raise ValueError(f"an operation must be known here, not {node.kind}")

    def _rounded(self, node: Operation, raw: str, right: str | None = None) -> str:
        source, target = node.operands[0].fmt, node.fmt
        drop = source.frac_bits - target.frac_bits
        if drop < 0:
            _check_width(node.name, source.width - drop, source.signed)
            raw, drop = _left(raw, -drop), 0
        bounds = f"{target.raw_min}, {target.raw_max}, {self._counter(target.name)}"
        if right:
            return f"shift_right<{str(node.detail == 'cut').lower()}>({raw}, {drop}, {right}, {bounds})"
        rounded = f"round_half_up({raw}, {drop})" if drop else raw
        low, high = (_shifted(extreme, source, target) for extreme in (source.raw_min, source.raw_max))
        if target.raw_min <= low and high <= target.raw_max:
            return rounded
        floor = f"{raw} >> {drop}" if drop else raw
        return f"saturate({rounded}, {floor}, {bounds})"


OPERATORS = {"add": "+", "sub": "-", "less": "<"}


def _name(node: Operation) -> str:
    return f"{node.name}_"  # no keyword of C++ ends like this


def _check_width(name: str, width: int, signed: bool):
    bits = width + (not signed)
    if bits > WIDEST:
        raise ValueError(f"{name} must have at most {WIDEST} bits, not {bits}: take shorter state words")


def _aligned(*nodes: Operation) -> list[str]:
    finest = max(node.fmt.frac_bits for node in nodes)
    return [_left(_name(node), finest - node.fmt.frac_bits) for node in nodes]


def _left(raw: str, by: int) -> str:
    return f"({raw} << {by})" if by else raw


def _shifted(raw: int, source, target) -> int:
    """``raw`` in the format ``target``, rounded half up."""
    drop = source.frac_bits - target.frac_bits
    return raw << -drop if drop <= 0 else (raw >> drop - 1) + 1 >> 1


def _table_field(node: Operation) -> str:
    read = node.operands[0]
    table, word = read.detail
    place = _name(read.operands[0])
    for index in read.operands[1:]:
        place = f"({place} << {index.fmt.width} | {_name(index)})"
    return f"common.{table}[{place} * {len(word)} + {list(word).index(node.detail)}]"
