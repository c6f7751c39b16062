"""What the wrappers of one third-party library share."""
