"""Fixed-point numbers: formats, integer arrays, graphs of operations, block arithmetic, records. May import nothing
else of the project; everybody may import it.
"""
