"""Meshes of triangles and tetrahedra: made, filled, read, written and judged.

May import golden.support; golden.physics, golden.scene and sim may import it.
"""
