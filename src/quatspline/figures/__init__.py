"""Pictures, drawn from tables alone."""
