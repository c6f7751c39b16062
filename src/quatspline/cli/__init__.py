"""The command line: what it takes, does and says."""

from quatspline.cli.commands import main

__all__ = ["main"]
