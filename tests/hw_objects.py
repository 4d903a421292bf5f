"""A circuit in Amaranth's simulator, and datapaths of a few operations."""

import gc
import re
import warnings
from collections import Counter
from contextlib import contextmanager

import numpy as np
import pytest
from amaranth.hdl import Cat, ClockDomain, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from amaranth.sim import Simulator

from golden.numbers.graph import Graph
from golden.numbers.qarray import QArray
from hw.machine.core import Core
from hw.pipeline.cost import Cost
from hw.pipeline.operations import shape
from hw.pipeline.pipe import FAULT_LATENCY, Pipe
from hw.pipeline.schedule import Schedule


def simulate(component, *benches):
    """Run testbenches on a component with a clock."""
    top = Module()
    top.domains.sync = ClockDomain()  # for a component without a register
    top.submodules.dut = component
    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    for bench in benches:
        simulator.add_testbench(bench)
    simulator.run()


class Piped(wiring.Component):
    """A graph as a pipeline: its inputs and ``valid`` come in cycle 0, its outputs leave in ``latency``."""

    def __init__(self, graph: Graph, cost: Cost):
        self._graph, self._schedule = graph, Schedule(graph, cost)
        self.latency = self._schedule.latency
        self.faults = graph.fault_names
        super().__init__(
            {
                "valid": In(1),
                **{name: In(shape(node.fmt)) for name, node in graph.inputs.items()},
                **{name: Out(shape(node.fmt)) for name, node in graph.outputs.items()},
                "fault": Out(len(self.faults)),
            }
        )

    def elaborate(self, platform):
        m = Module()
        inputs = {name: getattr(self, name) for name in self._graph.inputs}
        pipe = Pipe(m, self._schedule, inputs, self.valid)
        m.d.comb += [getattr(self, name).eq(pipe.output(name, self.latency)) for name in self._graph.outputs]
        m.d.comb += self.fault.eq(Cat(pipe.faults[name] for name in self.faults))
        pipe.build()
        return m


def stream(dut, inputs: dict[str, np.ndarray], outputs, gaps=None) -> dict[str, list]:
    """Feed a `Piped` one item per cycle. Return the outputs of each, and under ``faults`` how often each was reported.

    ``gaps``: how many cycles without a valid item come before each; the wires carry the next item's values then.
    """
    count = len(next(iter(inputs.values())))
    columns = [(getattr(dut, name), values.tolist()) for name, values in inputs.items()]
    gaps = [0] * count if gaps is None else gaps.tolist()
    starts = (np.cumsum(gaps) + np.arange(count)).tolist()
    results = {name: [] for name in outputs} | {"faults": Counter()}

    async def feed(ctx):
        for item, gap in enumerate(gaps):
            for port, values in columns:
                ctx.set(port, values[item])
            if gap:
                ctx.set(dut.valid, 0)
                await ctx.tick().repeat(gap)
            ctx.set(dut.valid, 1)
            await ctx.tick()
        ctx.set(dut.valid, 0)

    async def collect(ctx):
        due = set(starts)
        for cycle in range(starts[-1] + dut.latency + FAULT_LATENCY + 1):
            if cycle - dut.latency in due:
                for name in outputs:
                    results[name].append(ctx.get(getattr(dut, name)))
            faults = ctx.get(dut.fault)
            results["faults"].update(name for bit, name in enumerate(dut.faults) if faults >> bit & 1)
            await ctx.tick()

    simulate(dut, feed, collect)
    return results


def numbers(values: dict[str, np.ndarray], formats, faults: Counter) -> dict[str, QArray]:
    return {name: QArray(raw, formats[name], faults) for name, raw in values.items()}


@contextmanager
def only_asked():
    """Suppress Amaranth's warning about components that are made in here and never built."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
        gc.collect()


def refused(make, message: str):
    """Check that ``make()`` raises ValueError with exactly this message."""
    with only_asked(), pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        make()


def core_to_ask(parameters) -> Core:
    """Return a circuit that is only inspected, without Amaranth's warning that it is never built."""
    core = Core(parameters)
    core._MustUse__used = True
    return core
