"""The paper's figures, drawn from runs of the circuit with float64 beside it: `python -m sim figures`."""
