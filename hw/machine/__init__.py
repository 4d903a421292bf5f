"""The machine behind its host port: lanes, node updaters, lists and sequencer, joined by `hw.machine.interfaces`. It
imports blocks, pipeline, map and parameters; not link, emit, families or boards."""
