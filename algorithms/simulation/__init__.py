"""Scanned towns with known truth."""
