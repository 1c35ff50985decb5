"""Neighborhoods of points: which points they hold, and the covariances of these."""
