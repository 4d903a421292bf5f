"""The circuit: pipelines made from the datapath's graphs, memories, sequencer and host port."""
