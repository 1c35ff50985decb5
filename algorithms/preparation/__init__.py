"""Before anything else: outliers."""
