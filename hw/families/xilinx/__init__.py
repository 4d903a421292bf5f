"""Xilinx 7 series."""
