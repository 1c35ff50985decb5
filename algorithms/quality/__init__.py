"""Assessment of results."""
