"""From a scene to the integers that a circuit is loaded with, and back to SI.

May import golden and the memory map of hw; nothing else of sim."""
