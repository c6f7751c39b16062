"""Tab completion in shells, by argcomplete: names of schemes, of experiments, of options and of files.

bash and zsh learn it by ``eval "$(register-python-argcomplete quatspline)"``.
"""

from __future__ import annotations

import argparse
import os
from itertools import chain
from typing import Any

ASKED = "_ARGCOMPLETE"
"""The variable that a shell sets that asks what may follow."""


def offered(parser: argparse.ArgumentParser) -> None:
    """Answer a shell that asks what may follow, and end the process; otherwise do nothing."""
    if ASKED in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser)


def schemes(**asked: Any) -> list[str]:
    """Names of schemes, none of which is imported."""
    from quatspline import catalogue  # no command should wait for it

    return catalogue.names()


def listed_schemes(prefix: str, **asked: Any) -> list[str]:
    """Names of schemes behind those that a list already has, as in ``slerp,squad``."""
    before, comma, _ = prefix.rpartition(",")
    return [f"{before}{comma}{name}" for name in schemes()]


def experiments(**asked: Any) -> list[str]:
    """Names of experiments."""
    from quatspline.runs.experiment import files

    return list(files())


def options(parsed_args: argparse.Namespace, **asked: Any) -> list[str]:
    """Options of the schemes that the line names, with the "=" that their values follow."""
    from quatspline import catalogue
    from quatspline.cli.words import names
    from quatspline.options import declared_by

    groups = getattr(parsed_args, "schemes", None) or []
    given = [getattr(parsed_args, "scheme", None) or "", *names(chain(*groups))]
    known = [catalogue.scheme(name) for name in given if name in catalogue.schemes()]
    return sorted({f"{option}=" for scheme in known for option in declared_by(scheme)})
