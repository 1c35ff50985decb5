"""Before anything else: clouds merged, filtered and evened out, and noise found."""
