"""Scanned or photographed scenes with known truth."""
