"""Ground and heights above it."""
