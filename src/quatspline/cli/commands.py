"""The command line: list, options, run, compare, sample, reduce, info, motions, report, warmup.

Exit status: 0 done; 1 something unforeseen failed; 2 bad usage or bad input, told in one line on
stderr; 128 + n ended by signal n.  Whatever is slow to import waits until a command needs it.
"""

from __future__ import annotations

import argparse
import errno
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quatspline.cli.arguments import REFUSED, parser
from quatspline.cli.completion import offered
from quatspline.cli.notes import note
from quatspline.system.atomic import naming
from quatspline.system.ending import Ended, ending
from quatspline.system.sentence import one_line, printable
from quatspline.system.stdout import STDOUT, reserved, say

if TYPE_CHECKING:
    from quatspline.discovery import Found

DONE, FAILED, INTERRUPTED = 0, 1, 130

FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS}
"""Errors that say all there is to say: a disk has no room, or may not be written any more."""

CLAIMS: tuple[tuple[str, Callable[[Any], Any]], ...] = (
    ("C^k", lambda s: f"C{s.continuity}"),
    ("interpolates", lambda s: _yes(s.interpolates)),
    ("order", lambda s: str(s.order)),
    ("support", lambda s: _all_or(s.support)),
    ("lookahead", lambda s: _all_or(s.lookahead)),
    ("constant rate", lambda s: s.constant_rate),
    ("uneven times", lambda s: _yes(s.non_uniform)),
    ("closes", lambda s: _yes(s.closable)),
    ("iterates", lambda s: _yes(s.iterative)),
    ("from", lambda s: _maker(s.name)),
    ("title", lambda s: s.title),
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status."""
    given = list(sys.argv[1:] if argv is None else argv)
    if sys.stderr is None:  # closed: print would take stdout in its place
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    if sys.stdout is None:  # and the next file that is opened would get its number
        return _told("standard output is closed: point it to a file or to /dev/null", REFUSED)
    try:
        commands = parser()
        offered(commands)
        arguments = commands.parse_args(given)
        arguments.command = ["quatspline", *map(printable, given)]  # as files and pages can hold it
        with ending(partial(_interrupted, arguments.name)):
            with reserved():
                status = _served(arguments)
            with naming(STDOUT):
                sys.stdout.flush()
        return status
    except SystemExit as stop:  # argparse: help, version, bad usage
        return stop.code if isinstance(stop.code, int) else FAILED
    except KeyboardInterrupt as interrupt:
        status = interrupt.status if isinstance(interrupt, Ended) else INTERRUPTED
        return _interrupted(given[0] if given else "", status)
    except BrokenPipeError:  # the reader has seen enough
        _give_up_stdout()
        return DONE
    except ValueError as error:
        return _told(str(error), REFUSED)
    except Exception as error:
        return _unforeseen(error)


def _served(arguments: argparse.Namespace) -> int:
    """Serve a command; a scheme that would leave the program is an error like others, and no signal."""
    try:
        return COMMANDS[arguments.name](arguments)
    except BrokenPipeError as error:
        if error.filename == STDOUT:
            raise
        return _unforeseen(error)
    except (Exception, Ended):
        raise
    except BaseException as error:
        from quatspline.instruments.trials import reason

        return _told(f"{reason(error)}: raised by a scheme or a library", FAILED)


def _interrupted(command: str, status: int) -> int:
    hint = ": the same command resumes where it stopped" if command in ("run", "motions") else ""
    return _told(f"interrupted{hint}", status)


def _give_up_stdout() -> None:
    """Have what it still holds go nowhere: Python flushes once more at exit."""
    with suppress(OSError, ValueError):  # it may be no file of the system's
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _told(line: str, status: int) -> int:
    note(line)
    return status


def _unforeseen(error: Exception) -> int:
    from quatspline.solving import ConvergenceError

    ours = isinstance(error, OSError) and error.filename == STDOUT
    if ours:
        _give_up_stdout()
    if isinstance(error, OSError) and (ours or error.errno in FULL):
        where = f"{error.filename}: " if error.filename is not None else ""
        return _told(f"{where}cannot be written: {error.strerror}", FAILED)
    if not isinstance(error, ConvergenceError):
        traceback.print_exception(error)
    return _told(f"{type(error).__name__}: {error}", FAILED)


# -- commands -----------------------------------------------------------------------------------


def _list(arguments: argparse.Namespace) -> int:
    from quatspline import catalogue

    items = list(catalogue.found().values())
    rows = [["scheme", *(head for head, _ in CLAIMS)]]
    rows += [[item.name, *_claims(item)] for item in items if item.scheme is not None]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    say("  ".join(map(str.ljust, row, widths)).rstrip() for row in rows)
    unusable = [item for item in items if item.scheme is None]
    say(f"{i.name.ljust(widths[0])}  n/a: {one_line(str(i.problem))}" for i in unusable)
    return DONE


def _claims(item: Found) -> list[str]:
    def cell(show: Callable[[Any], Any]) -> str:
        with suppress(
            Exception
        ):  # a claim that the file does not make, or one that cannot be shown
            return str(show(item.scheme))
        return "?"

    return [cell(show) for _, show in CLAIMS]


def _all_or(keyframes: int | None) -> str:
    return "all" if keyframes is None else str(keyframes)


def _maker(name: str) -> str:
    from quatspline.catalogue import maker

    return maker(name)


def _yes(claim: bool) -> str:
    return "yes" if claim else "no"


def _options(arguments: argparse.Namespace) -> int:
    from quatspline.cli import options

    return options.command(arguments.scheme)


def _run(arguments: argparse.Namespace) -> int:
    from quatspline.cli import running, words

    experiments, schemes = words.of_run(arguments.experiments, arguments.schemes)
    failed = running.run(
        experiments,
        schemes=schemes,
        size=arguments.size,
        seed=arguments.seed,
        out=arguments.out,
        command=arguments.command,
        jobs=arguments.jobs,
        dask=arguments.dask,
        force=arguments.force,
    )
    return FAILED if failed else DONE


def _compare(arguments: argparse.Namespace) -> int:
    from quatspline.cli import asked, compare, joints, options, recorded, words
    from quatspline.runs.results import Results

    # A wrong name is told before a long file is read.
    arguments.keyframes, schemes = words.of_compare(arguments.keyframes, arguments.schemes)
    given = options.of_schemes(schemes, arguments.options)
    motion = recorded.motion_of(arguments)
    needs = asked.needs(arguments, motion)
    asked.check_tracks(arguments, motion, needs)
    recorded.tell_unread(arguments, motion)
    body = len(motion.tracks) == 1
    out = arguments.out or Path(f"{Path(arguments.keyframes).stem}-compared")
    results = Results(out, force=arguments.force)
    with results.writing():
        results.guard((compare if body else joints).FILES, inputs=[arguments.keyframes])
        common = {"schemes": schemes, "results": results, "call": arguments.command}
        common |= {"name": printable(Path(arguments.keyframes).name), "options": given}
        common |= {"needs": needs}
        if not body:
            return joints.command(motion, every=arguments.keep, **common)
        common |= {"told": asked.told(arguments, motion)}
        return compare.command(motion, closed=arguments.closed, every=arguments.keep, **common)


def _report(arguments: argparse.Namespace) -> int:
    from quatspline import page

    return page.command(arguments.out, open_it=arguments.open, force=arguments.force)


def _sample(arguments: argparse.Namespace) -> int:
    from quatspline.cli import recorded

    recorded.sample(arguments)
    return DONE


def _reduce(arguments: argparse.Namespace) -> int:
    from quatspline.cli import recorded

    recorded.reduce(arguments)
    return DONE


def _info(arguments: argparse.Namespace) -> int:
    from quatspline.cli import recorded

    recorded.info(arguments)
    return DONE


def _motions(arguments: argparse.Namespace) -> int:
    from quatspline.cli import motions

    return motions.command(arguments.folder, mirror=arguments.mirror, force=arguments.force)


def _warm_up(arguments: argparse.Namespace) -> int:
    from quatspline.runs.warmup import main

    main()
    return DONE


COMMANDS = {
    "list": _list,
    "options": _options,
    "run": _run,
    "compare": _compare,
    "sample": _sample,
    "reduce": _reduce,
    "info": _info,
    "motions": _motions,
    "report": _report,
    "warmup": _warm_up,
}
