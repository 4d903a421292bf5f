"""From a graph of operations to registers: cost, schedule, pipeline, delay lines. May import `golden.numbers`,
`golden.datapath` and `hw.blocks`; `hw.machine` and `hw.emit` import it.
"""
