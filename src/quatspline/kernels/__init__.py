"""Compilation, quaternions as values, and the driver that evaluates segments."""
