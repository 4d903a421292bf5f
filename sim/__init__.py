"""Co-simulation: scenes on the float64 model, the integer model and the simulated circuit, compared."""
