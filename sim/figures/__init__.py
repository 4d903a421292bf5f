"""The paper's figures, drawn from runs of the circuit with float64 beside it: ``python -m sim figures``. Only the
commands import it; it imports runs, results, the report's style and golden."""
