"""How a cloud samples its surfaces: density, spacing, noise, height resolution."""
