"""Experiments, their cells, the journal, and the folder of results."""
