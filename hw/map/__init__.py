"""The memory map: regions, words and control registers as the host addresses them. The machine, the link, emit and sim
import it; it imports sizes, parameters and golden."""
