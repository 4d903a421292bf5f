"""The equations in fixed point: formats, records, tables, named quantities, graphs and the integer model. May import
`golden.numbers` only; the circuit, the encoder and the backends import it.
"""
