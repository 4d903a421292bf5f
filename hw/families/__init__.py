"""Device families: a folder each, whose ``family.py`` defines one `hw.families.family.Family` named ``FAMILY``.

May import golden, hw.blocks and hw.pipeline; a family's folder is imported by `hw.families.registry` alone."""
