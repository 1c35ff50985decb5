"""Pages and charts that show results to a person."""
