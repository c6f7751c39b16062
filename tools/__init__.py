"""What serves this repository only."""
