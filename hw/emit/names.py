"""Make the Verilog that Yosys writes readable: plain names, no unused wires, nothing a linter would ask about."""

import re
import textwrap
from collections import Counter
from itertools import count

NAME = r"[A-Za-z_]\w*"
REGISTER = re.compile(r"^  always @\(posedge clk\)\n    (\S+) +<= \\(\$\d+) ;$", re.MULTILINE)
CONNECTION = re.compile(rf"^(    \.{NAME})\(({NAME})\)", re.MULTILINE)
WIRE = re.compile(rf"^  wire (?:\[.*\] )?({NAME});\n", re.MULTILINE)
ALIAS = re.compile(rf"^  (?:wire (?:\[.*\] )?|assign )({NAME})(?:;| = .*)\n", re.MULTILINE)
HEADER = re.compile(rf"^module ({NAME}) ?\(([^;]*)\);")
REPEATED = re.compile(rf"(?<=[{{,] )({NAME}(?:\[\d+\])?)((?:, \1)+)(?=[, ])")
CASE = re.compile(r"^( *)casez (?:.*\n)*?\1endcase$", re.MULTILINE)


def readable(verilog: str) -> str:
    """Return the same modules. A register's next value is named after it, other intermediate results ``t<number>``."""
    return re.sub(r"^module (?:.*\n)*?endmodule$", lambda module: _module(module[0]), verilog, flags=re.MULTILINE)


def _module(text: str) -> str:
    text = HEADER.sub(_clock_first, _left_open(_without_aliases(_renamed(text))))
    text = REPEATED.sub(lambda bits: f"{{{bits[2].count(',') + 1}{{{bits[1]}}}}}", text)  # a sign that is extended
    text = re.sub(rf"= ! ({NAME})", r"= ~| \1", text)  # of several bits
    # In SystemVerilog a declaration sets its value before any process runs: that is no event
    text = text.replace("  reg initial_event = 0;\n", "  reg initial_event;\n  initial initial_event = 0;\n")
    return CASE.sub(_with_default, text)


def _renamed(text: str) -> str:
    names, taken = {}, set(re.findall(rf"(?<![\\\w$]){NAME}", text))
    registers = REGISTER.findall(text)
    values = Counter(value for _, value in registers)
    wanted = {value: f"{_plain(register)}_next" for register, value in registers if values[value] == 1}
    for name in dict.fromkeys(re.findall(r"\\(\S+)", text)):
        stem = wanted.get(name) or _plain("\\" + name)
        candidates = (f"{stem}_{number}" if number > 1 else stem for number in count(1))
        names[name] = next(candidate for candidate in candidates if candidate not in taken)
        taken.add(names[name])
    return re.sub(r"\\(\S+) ?", lambda match: names[match[1]], text)


def _plain(name: str) -> str:
    """Return a legal name for one that may be escaped."""
    if re.fullmatch(r"\\\$\d+", name):
        return f"t{name[2:]}"
    if name.startswith("\\$auto$verilog_backend"):
        return "initial_event"  # lets an always block run once even if its inputs never change
    legal = re.sub(r"\W+", "_", name).strip("_")
    return f"{legal}_" if name == f"\\{legal}" else legal  # a legal name that is escaped is a reserved word


def _without_aliases(text: str) -> str:
    """Drop wires that are assigned and never read: second names of others, or unused parts of a result."""
    while True:
        uses = Counter(re.findall(rf"(?<![.\w]){NAME}", text))
        assigned = re.findall(rf"^  assign ({NAME}) = ", text, re.MULTILINE)
        idle = {name for name in assigned if uses[name] == 2}  # declaration and assignment; a port has more
        if not idle:
            return text
        text = ALIAS.sub(lambda line, idle=idle: "" if line[1] in idle else line[0], text)


def _left_open(text: str) -> str:
    """Leave an instance's output open if its wire goes nowhere."""
    uses = Counter(re.findall(rf"(?<![.\w]){NAME}", text))
    idle = {name for _, name in CONNECTION.findall(text) if uses[name] == 2}  # declaration and connection
    text = WIRE.sub(lambda wire: "" if wire[1] in idle else wire[0], text)
    return CONNECTION.sub(lambda port: f"{port[1]}()" if port[2] in idle else port[0], text)


def _clock_first(header: re.Match) -> str:
    ports = header[2].replace("\n", " ").replace(" ", "").split(",")
    ports.insert(0, ports.pop())  # Amaranth counts ports from 0, and Yosys puts number 0 last
    ports.sort(key=lambda port: port not in ("clk", "rst"))
    return textwrap.fill(f"module {header[1]}({', '.join(ports)});", 110, subsequent_indent="    ")


def _with_default(case: re.Match) -> str:
    if re.search(rf"^{case[1]}  default:", case[0], re.MULTILINE):
        return case[0]
    return case[0].removesuffix("endcase") + f"  default: ;\n{case[1]}endcase"
