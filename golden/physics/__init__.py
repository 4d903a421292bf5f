"""The equations in float64: materials and their dampers, the model, stability. It knows nothing of the circuit.

May import golden.mesh and golden.support; golden.scene and sim may import it.
"""
