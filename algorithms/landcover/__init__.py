"""What covers the ground next to buildings: vegetation, water, wires."""
