"""What covers the ground beside buildings: vegetation, water, wires."""
