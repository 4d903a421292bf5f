"""Scenes on float64, in the circuit's integers and in the circuit itself, compared, drawn and measured."""
