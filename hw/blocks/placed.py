"""An instance of a Verilog module that is made elsewhere."""

from amaranth.hdl import ClockSignal, Instance, ResetSignal
from amaranth.lib import wiring
from amaranth.lib.wiring import In


class Placed(wiring.Component):
    """The module ``module``, with the ports of ``signature``, ``clk`` and ``rst``.

    Parameters
    ----------
    module : str
    signature
        A component's signature, or its members.
    reset : Value
        The module's reset; by default the reset of the clock domain.

    Raises
    ------
    NotImplementedError
        If Amaranth's simulator elaborates it: the simulator would leave the module out.
    """

    def __init__(self, module: str, signature, *, reset=None):
        self._module, self._reset = module, reset
        super().__init__(signature)

    def elaborate(self, platform):
        if platform is None:
            raise NotImplementedError(f"{self._module} must be emitted as Verilog, not simulated by Amaranth")
        ports = {"i_clk": ClockSignal(), "i_rst": ResetSignal() if self._reset is None else self._reset}
        for path, member, port in self.signature.flatten(self):
            ports[f"{'i' if member.flow == In else 'o'}_{'__'.join(map(str, path))}"] = port
        return Instance(self._module, **ports)
