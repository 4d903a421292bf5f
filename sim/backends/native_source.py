"""The C++ text of the datapath's graphs, which ``native.cpp`` includes: one constant an operation, under its name."""

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import edge_graph, node_graph
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES, Graph, Operation
from golden.numbers.qformat import round_half_up

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
    faults = sorted({*edge.fault_names, *node.fault_names})
    material, inverse_mass = records.material(fmt, tables=1), records.inverse_mass(fmt)
    stages = [RK4.stage(s) for s in range(RK4.stages)]
    common = {"velocity_shift": "common.velocity_shift"} | {f"stage_{bit}": f"stage_{bit}[stage]" for bit in stages[0]}

    edge_variables = common | _record("material", material, "edge.material") | _vector("pull", "pull")
    edge_variables |= {f"edge_{name}": f"edge.{name}" for name in records.edge_state(fmt)}
    edge_variables |= {f"{name}_next": f"edge.{name}" for name in ("base", "ratio", "total")}
    for end in "ij":
        edge_variables |= _vector(f"{end}_x", f"{end}.x") | _vector(f"{end}_v", f"{end}.v")

    node_variables = common | _record("inverse_mass", inverse_mass, "node.inverse_mass") | _vector("pull0", "node.pull")
    for name in ("load", "force", "x", *records.node_state(fmt)):
        node_variables |= _vector(name, f"node.{name}") | _vector(f"{name}_next", f"node.{name}")

    constants = {"int STAGES": len(stages)}
    constants |= {"int MATERIAL_FIELDS": len(material), "int INVERSE_MASS_FIELDS": len(inverse_mass)}
    constants |= {f"Int stage_{bit}[]": f"{{{', '.join(str(s[bit]) for s in stages)}}}" for bit in stages[0]}
    files = {
        "constants.inc": "".join(f"constexpr {name} = {value};\n" for name, value in constants.items()),
        "edge.inc": _Program(edge, edge_variables, faults).text,
        "node.inc": _Program(node, node_variables, faults).text,
    }
    return files, faults


def _vector(name: str, variable: str) -> dict[str, str]:
    return {f"{name}_{axis}": f"{variable}[{number}]" for number, axis in enumerate(AXES)}


def _record(prefix: str, record: dict, variable: str) -> dict[str, str]:
    return {f"{prefix}_{name}": f"{variable}[{number}]" for number, name in enumerate(record)}


class _Program:
    """The C++ statements of one graph, ``text``; ``variables`` has the C++ variable of each input and output."""

    def __init__(self, graph: Graph, variables: dict[str, str], faults: list[str]):
        self._variables, self._faults = variables, faults
        lines = []
        for operation in graph.operations:
            if operation.kind != "read":  # a word, wider than an int64: its fields are read one by one
                _check_width(operation.name, operation.fmt.width, operation.fmt.signed)
                lines.append(
                    f"const Int {_name(operation)} = {self._expression(operation, *map(_name, operation.operands))};"
                )
        lines += [f"*{self._counter(name)} += {_name(bit)};" for name, bit in graph.faults]
        lines += [f"{variables[label]} = {_name(operation)};" for label, operation in graph.outputs.items()]
        self.text = "".join(f"{line}\n" for line in lines)

    def _counter(self, name: str) -> str:
        return f"(common.faults + {self._faults.index(name)})" if name else "nullptr"

    def _expression(self, operation: Operation, *operands: str) -> str:
        match operation.kind:
            case "input":
                return self._variables[operation.name]
            case "const":
                return str(operation.detail)
            case "sum":
                return " + ".join(_aligned(*operation.operands))
            case "add" | "sub" | "less":
                return f" {OPERATORS[operation.kind]} ".join(_aligned(*operation.operands))
            case "mul":
                return " * ".join(operands)
            case "abs":
                return f"{operands[0]} < 0 ? -{operands[0]} : {operands[0]}"
            case "select":
                return f"{operands[0]} ? " + " : ".join(_aligned(*operation.operands[1:]))
            case "scale":
                return operands[0]
            case "field":
                sign = operation.fmt.signed << operation.fmt.width - 1
                return f"({operands[0]} >> {operation.detail} & {(1 << operation.fmt.width) - 1} ^ {sign}) - {sign}"
            case "shift_left":
                return " << ".join(operands)
            case "lead":
                q = operation.operands[0].fmt
                magnitudes = " | ".join(f"magnitude({x})" for x in operands)
                return f"lead({magnitudes}, {q.width - q.signed}, {operation.detail})"
            case "part":
                return _table_field(operation)
            case "round" | "shift_right":
                return self._rounded(operation, *operands)
        raise ValueError(f"an operation must be known here, not {operation.kind}")

    def _rounded(self, operation: Operation, raw: str, right: str | None = None) -> str:
        source, target = operation.operands[0].fmt, operation.fmt
        drop = source.frac_bits - target.frac_bits
        if drop < 0:
            _check_width(operation.name, source.width - drop, source.signed)
            raw, drop = _left(raw, -drop), 0
        bounds = f"{target.raw_min}, {target.raw_max}, {self._counter(target.name)}"
        if right:
            return f"shift_right<{str(operation.detail == 'cut').lower()}>({raw}, {drop}, {right}, {bounds})"
        rounded = f"round_half_up({raw}, {drop})" if drop else raw
        left = max(target.frac_bits - source.frac_bits, 0)
        low, high = (round_half_up(extreme << left, drop) for extreme in (source.raw_min, source.raw_max))
        if target.raw_min <= low and high <= target.raw_max:
            return rounded
        floor = f"{raw} >> {drop}" if drop else raw
        return f"saturate({rounded}, {floor}, {bounds})"


OPERATORS = {"add": "+", "sub": "-", "less": "<"}


def _name(operation: Operation) -> str:
    return f"{operation.name}_"  # no keyword of C++ ends like this


def _check_width(name: str, width: int, signed: bool):
    bits = width + (not signed)
    if bits > WIDEST:
        raise ValueError(f"{name} must have at most {WIDEST} bits, not {bits}: take shorter state words")


def _aligned(*operations: Operation) -> list[str]:
    finest = max(operation.fmt.frac_bits for operation in operations)
    return [_left(_name(operation), finest - operation.fmt.frac_bits) for operation in operations]


def _left(raw: str, by: int) -> str:
    return f"({raw} << {by})" if by else raw


def _table_field(operation: Operation) -> str:
    read = operation.operands[0]
    table, word = read.detail
    index = _name(read.operands[0])
    for part in read.operands[1:]:
        index = f"({index} << {part.fmt.width} | {_name(part)})"
    return f"common.{table}[{index} * {len(word)} + {list(word).index(operation.detail)}]"
