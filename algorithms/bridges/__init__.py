"""Bridges, and the ground that segments show around them."""
