"""Decide which clusters are buildings and which points belong to them."""
