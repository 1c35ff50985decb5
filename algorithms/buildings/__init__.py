"""Which clusters are buildings, and which points belong to them."""
