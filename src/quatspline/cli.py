"""The command line: list, run, compare, sample, report.

Exit status: 0 done; 1 something unforeseen failed; 2 bad usage or bad input, told in one line on
stderr; 130 interrupted.  Whatever is slow to import waits until a command needs it.
"""

from __future__ import annotations

import argparse
import errno
import math
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NoReturn

from quatspline import __version__
from quatspline.atomic import same_file

if TYPE_CHECKING:
    from quatspline.registry import Found
    from quatspline.trajectories.files import Motion

DONE, FAILED, REFUSED, INTERRUPTED = 0, 1, 2, 130


FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS}
"""Errors that say all there is to say: a disk has no room, or may not be written any more."""

CLAIMS: tuple[tuple[str, Callable[[Any], Any]], ...] = (
    ("C^k", lambda s: f"C{s.continuity}"),
    ("interpolates", lambda s: _yes(s.interpolates)),
    ("order", lambda s: str(s.order)),
    ("support", lambda s: "all" if s.support is None else str(s.support)),
    ("constant rate", lambda s: s.constant_rate),
    ("uneven times", lambda s: _yes(s.non_uniform)),
    ("closes", lambda s: _yes(s.closable)),
    ("iterates", lambda s: _yes(s.iterative)),
    ("from", lambda s: s.peer or "quatspline"),
    ("title", lambda s: s.title),
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status."""
    given = list(sys.argv[1:] if argv is None else argv)
    try:
        arguments = _parser().parse_args(given)
        arguments.command = ["quatspline", *given]
        status = arguments.call(arguments)
        sys.stdout.flush()
        return status
    except SystemExit as stop:  # argparse: help, version, bad usage
        return stop.code if isinstance(stop.code, int) else FAILED
    except KeyboardInterrupt:
        hint = ": the same command goes on where it stopped" if given[:1] == ["run"] else ""
        return _told(f"interrupted{hint}", INTERRUPTED)
    except BrokenPipeError:  # the reader has seen enough; Python must not flush once more at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except ValueError as error:
        return _told(str(error), REFUSED)
    except Exception as error:
        return _unforeseen(error)


def _told(line: str, status: int) -> int:
    _note(line)
    return status


def _note(line: str) -> None:
    print(f"quatspline: {' '.join(line.split())}", file=sys.stderr)


def _unforeseen(error: Exception) -> int:
    from quatspline.solving import ConvergenceError

    full = isinstance(error, OSError) and error.errno in FULL
    if not full and not isinstance(error, ConvergenceError):
        traceback.print_exception(error)
    return _told(f"{type(error).__name__}: {error}", FAILED)


# -- arguments ----------------------------------------------------------------------------------


class _Parser(argparse.ArgumentParser):
    """Tells bad usage in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(REFUSED, f"{self.prog}: {message} (see {self.prog} --help)\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="quatspline", description="The benchmark of orientation interpolation.")
    parser.add_argument("--version", action="version", version=f"quatspline {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True, dest="name")
    commands.add_parser("list", help="schemes and what they claim").set_defaults(call=_list)
    _add_run(commands)
    _add_compare(commands)
    _add_sample(commands)
    _add_report(commands)
    return parser


def _add_run(commands: Any) -> None:
    run = commands.add_parser(
        "run",
        help="experiments: tables, figures and a manifest",
        description="Run experiments: by default all, the paper's in full and the others at quick "
        "size. A run that was interrupted goes on where it stopped when started alike.",
    )
    run.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help="by default all")
    _add_schemes(run)
    size = run.add_mutually_exclusive_group()
    size.add_argument("--quick", dest="size", action="store_const", const="quick")
    size.add_argument("--full", dest="size", action="store_const", const="full")
    run.add_argument("--out", type=Path, default=Path("results"), metavar="DIR", help="%(default)s")
    _add_force(run)
    run.add_argument("--seed", type=_seed, default=0, metavar="N", help="%(default)s")
    where = run.add_mutually_exclusive_group()
    where.add_argument("--jobs", type=_count, metavar="N", help="processes; by default one a core")
    where.add_argument("--dask", metavar="ADDRESS", help="a Dask scheduler that measures instead")
    run.set_defaults(call=_run)


def _add_compare(commands: Any) -> None:
    compare = commands.add_parser("compare", help="schemes on your own keyframes")
    _add_keyframes(compare, nargs="?")  # it may stand behind the words of --schemes
    _add_schemes(compare)
    where = "for tables, figures and the page; by default KEYFRAMES-compared here"
    compare.add_argument("--out", type=Path, metavar="DIR", help=where)
    _add_force(compare)
    compare.set_defaults(call=_compare)


def _add_sample(commands: Any) -> None:
    sample = commands.add_parser("sample", help="a scheme's curve through keyframes, sampled")
    _add_keyframes(sample)
    sample.add_argument("--scheme", required=True, metavar="S", help="see quatspline list")
    grid = sample.add_mutually_exclusive_group(required=True)
    grid.add_argument("--rate", type=_rate, metavar="HZ", help="samples per time unit")
    grid.add_argument(
        "--count", type=_count, metavar="N", help="samples in all, both ends included"
    )
    sample.add_argument("-o", dest="file", metavar="FILE", help="by default CSV on stdout")
    sample.set_defaults(call=_sample)


def _add_report(commands: Any) -> None:
    report = commands.add_parser("report", help="the page that shows the results")
    report.add_argument(
        "--out", type=Path, default=Path("results"), metavar="DIR", help="%(default)s"
    )
    _add_force(report)
    report.add_argument("--open", action="store_true", help="in the browser")
    report.set_defaults(call=_report)


def _add_keyframes(parser: argparse.ArgumentParser, nargs: Literal["?"] | None = None) -> None:
    kinds = (
        "CSV (t,qw,qx,qy,qz, or columns named in a header), TUM (t tx ty tz qx qy qz qw) or NPZ "
        "(times, quaternions, positions)"
    )
    parser.add_argument("keyframes", metavar="KEYFRAMES", help=kinds, nargs=nargs)
    closing = "a closed curve: the last row repeats the first orientation, or times are uniform"
    parser.add_argument("--closed", action="store_true", help=closing)


def _add_schemes(parser: argparse.ArgumentParser) -> None:
    names = "names, by blanks or commas"
    parser.add_argument("--schemes", nargs="+", metavar="S", action="append", help=names)


def _add_force(parser: argparse.ArgumentParser) -> None:
    replaced = "replace files that quatspline did not write, or that were edited since"
    parser.add_argument("--force", action="store_true", help=replaced)


def _number(kind: type, accepts: Callable[[Any], bool], wanted: str) -> Callable[[str], Any]:
    def parsed(text: str) -> Any:
        with suppress(ValueError):
            if accepts(value := kind(text)):
                return value
        raise argparse.ArgumentTypeError(f"{text!r}: {wanted} is expected")

    return parsed


_rate = _number(float, lambda value: 0.0 < value < math.inf, "a positive number")
_count = _number(int, lambda value: value >= 1, "a whole number, at least 1,")
_seed = _number(int, lambda value: value >= 0, "a whole number, at least 0,")


# -- commands -----------------------------------------------------------------------------------


def _list(arguments: argparse.Namespace) -> int:
    from quatspline import registry

    items = list(registry.found().values())
    rows = [["scheme", *(head for head, _ in CLAIMS)]]
    rows += [[item.name, *_claims(item)] for item in items if item.scheme is not None]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        print("  ".join(cells).rstrip())
    for item in items:
        if item.scheme is None:
            print(f"{item.name.ljust(widths[0])}  n/a: {' '.join(str(item.problem).split())}")
    return DONE


def _claims(item: Found) -> list[str]:
    def cell(show: Callable[[Any], Any]) -> str:
        with suppress(AttributeError):  # a claim that the file does not make
            return str(show(item.scheme))
        return "?"

    return [cell(show) for _, show in CLAIMS]


def _yes(claim: bool) -> str:
    return "yes" if claim else "no"


def _run(arguments: argparse.Namespace) -> int:
    from quatspline import running, words

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
    from quatspline import comparing, words
    from quatspline.report.results import Results

    # A wrong name is told before a long file is read.
    arguments.keyframes, schemes = words.of_compare(arguments.keyframes, arguments.schemes)
    motion = _motion(arguments)
    out = arguments.out or Path(f"{Path(arguments.keyframes).stem}-compared")
    results = Results(out, force=arguments.force)
    with results.writing():
        results.guard(comparing.FILES, inputs=[arguments.keyframes])
        return comparing.command(
            motion,
            schemes=schemes,
            closed=arguments.closed,
            results=results,
            call=arguments.command,
        )


def _report(arguments: argparse.Namespace) -> int:
    from quatspline.report import page

    return page.command(arguments.out, open_it=arguments.open, force=arguments.force)


def _sample(arguments: argparse.Namespace) -> int:
    from quatspline import registry
    from quatspline.grid import sample_times
    from quatspline.trajectories import files

    registry.scheme(arguments.scheme)  # a wrong name is told before a long file is read
    if arguments.file is not None:
        files.check_suffix(arguments.file)
        if same_file(arguments.keyframes, arguments.file):
            raise ValueError(f"{arguments.file}: is read here, so it is not written over")
    motion = _motion(arguments)
    with _naming(arguments.keyframes):
        curve = registry.build(
            arguments.scheme, motion.times, motion.quaternions, closed=arguments.closed
        )
    times = sample_times(*curve.domain, arguments.rate, arguments.count)
    samples = motion.sampled(times, curve(times))
    if motion.unread:
        _note(f"{arguments.keyframes}: not carried: {', '.join(map(repr, motion.unread))}")
    if arguments.file is None:
        files.write_csv(sys.stdout, samples)
    else:
        files.write(arguments.file, samples)
    return DONE


def _motion(arguments: argparse.Namespace) -> Motion:
    from quatspline.keyframes import prepare
    from quatspline.trajectories import files

    motion = files.read(arguments.keyframes)
    with _naming(arguments.keyframes):
        motion = motion.returning() if arguments.closed else motion.opened()
        prepare(motion.times, motion.quaternions, closed=arguments.closed)
    if motion.note:
        _note(f"{arguments.keyframes}: {motion.note}")
    return motion


@contextmanager
def _naming(path: str) -> Iterator[None]:
    """What is wrong with the keyframes of a file is told with the file's name."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
