"""The files that are written from a circuit: Verilog, manifest, pages. It imports machine, link and families; boards
and the commands import it."""
