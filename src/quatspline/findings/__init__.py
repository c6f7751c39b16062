"""Sentences with their sources: what was found, what to choose, whether targets are met."""
