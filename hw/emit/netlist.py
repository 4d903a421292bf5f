"""A component as a netlist of modules: each kind of component once, its ports the members it documents."""

import re

from amaranth.back import rtlil
from amaranth.hdl import ClockSignal, Fragment, Instance, ResetSignal, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In

PLACEHOLDER = "name_of_the_module"
NAMELESS = re.compile(r"^  wire .*\\(\$[a-z]\S*)$", re.MULTILINE)
"""Names that Amaranth makes up for signals without one: they begin with a $ and a letter."""


class NoBlocks:
    """A platform without modules of its own; None would be the simulator."""


def netlist(component: wiring.Component, name: str, platform=None) -> str:
    """Return RTLIL of ``component`` as the module ``name``, and of its parts as modules ``<name>_<kind>``.

    The kind is the component's attribute ``kind``, or else its class; a component that elaborates to an instance
    (`hw.blocks.placed.Placed`) stays one. Elaborates the component; the wires of its submodules' ports are renamed
    after submodule and port. The components may ask ``platform`` for modules of its own (`hw.families.family.Blocks`).

    Raises
    ------
    ValueError
        If a signal has no name: Amaranth found none where it was made, or would not with another interpreter.
    """
    kinds = _Kinds(name)
    kinds.add(Fragment.get(component, platform or NoBlocks()), component, name)
    return "\n".join(text.replace(PLACEHOLDER, kind) for kind, text in kinds.modules.items())


class _Kinds:
    """``modules`` is RTLIL by name. Components that give the same text share a module."""

    def __init__(self, prefix: str):
        self._prefix = prefix
        self.modules: dict[str, str] = {}

    def add(self, fragment: Fragment, component: wiring.Component, name: str) -> str:
        """Return the name of the component's module."""
        for number, (child, label, source) in enumerate(fragment.subfragments):
            if (part := _component(child)) is not None:
                instance = self._place(child, part, label)
                fragment.subfragments[number] = (instance, label, source)
        ports = {label: (value, None) for label, _, value in _ports(component)}
        text, _ = rtlil.convert_fragment(fragment, ports, PLACEHOLDER, emit_src=False)
        if nameless := NAMELESS.findall(text):
            raise ValueError(f"every signal of {name} must have a name, not {', '.join(sorted(set(nameless)))}")
        names = (name, *(f"{name}_{number}" for number in range(2, 100)))
        name = next(name for name in names if self.modules.get(name, text) == text)
        self.modules[name] = text
        return name

    def _place(self, fragment: Fragment, component: wiring.Component, label: str) -> Instance:
        instance = fragment
        if not isinstance(fragment, Instance):
            kind = self.add(fragment, component, f"{self._prefix}_{_kind(component)}")
            clocks = {"clk": ClockSignal(), "rst": ResetSignal()}.items()
            connections = {f"i_{port}": value for port, value in clocks if _has_input(self.modules[kind], port)}
            for port, member, value in _ports(component):
                connections[f"{'i' if member.flow == In else 'o'}_{port}"] = value
            instance = Instance(kind, **connections)
        for port, _, value in _ports(component):
            if isinstance(value, Signal):
                value.name = f"{label}_{port}"
        return instance


def _has_input(text: str, port: str) -> bool:
    return re.search(rf"^  wire .*\binput \d+ .*\\{port}$", text, re.MULTILINE) is not None


def _component(fragment: Fragment) -> wiring.Component | None:
    """Return the component of this project that the fragment was elaborated from."""
    package = __package__.partition(".")[0]
    for origin in fragment.origins or ():
        if isinstance(origin, wiring.Component) and type(origin).__module__.startswith(f"{package}."):
            return origin
    return None


def _kind(component: wiring.Component) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(component).__name__).lower()
    return getattr(component, "kind", words)


def _ports(component: wiring.Component):
    """Yield (name, member, value) of all ports."""
    for path, member, value in component.signature.flatten(component):
        yield "__".join(map(str, path)), member, Value.cast(value)
