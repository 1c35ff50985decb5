"""Local geometry of each point."""
