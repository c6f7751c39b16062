"""The arguments of the command line: which there are, and what is said of bad ones."""

from __future__ import annotations

import argparse
import ast
import math
import sys
from collections.abc import Callable
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, NoReturn

from quatspline import __version__
from quatspline.system.atomic import naming
from quatspline.system.sentence import MOST as SENTENCE
from quatspline.system.sentence import one_line
from quatspline.system.stdout import STDOUT

REFUSED = 2
"""The status of bad usage and bad input."""


class _Parser(argparse.ArgumentParser):
    """Tells bad usage in one line, and what follows its help when that is asked for."""

    closing: Callable[[], str] | None = None

    def format_help(self) -> str:
        """The help, and what closes it."""
        text = super().format_help()
        return f"{text}\n{self.closing()}\n" if self.closing else text

    def error(self, message: str) -> NoReturn:
        begin, end = f"{self.prog}: ", f" (see {self.prog} --help)"
        room = SENTENCE - len(begin) - len(end)
        self.exit(REFUSED, f"{begin}{one_line(message, room)}{end}\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        """As argparse does, which is silent where standard output takes nothing."""
        if not message or file is not sys.stdout:
            super()._print_message(message, file)
            return
        with naming(STDOUT):
            print(message, end="", file=file, flush=True)


def parser() -> argparse.ArgumentParser:
    """The parser of all commands; ``name`` is the command's."""
    whole = _Parser(prog="quatspline", description="The benchmark of orientation interpolation.")
    whole.add_argument("--version", action="version", version=f"quatspline {__version__}")
    commands = whole.add_subparsers(metavar="COMMAND", required=True, dest="name")
    commands.add_parser("list", help="schemes and what they claim")
    options = commands.add_parser("options", help="the options of a scheme")
    options.add_argument("scheme", metavar="SCHEME", help="see quatspline list")
    _add_run(commands)
    _add_compare(commands)
    _add_sample(commands)
    _add_reduce(commands)
    _add_info(commands)
    _add_motions(commands)
    _add_report(commands)
    commands.add_parser("warmup", help="compile everything once, so that nothing waits later")
    return whole


def _add_run(commands: Any) -> None:
    run = commands.add_parser(
        "run",
        help="experiments: tables, figures and a manifest",
        description="Run experiments: by default all, the paper's in full and the others at quick "
        "size. A run that was interrupted goes on where it stopped when started alike.",
    )
    run.closing = _experiments
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


def _experiments() -> str:
    """Each experiment with the first line of its file; none is loaded."""
    from quatspline.runs.experiment import files

    said = {name: _first_line(path) for name, path in files().items()}
    width = max(map(len, said), default=0)
    return "\n".join(
        ["experiments:", *(f"  {name:{width}}  {line}" for name, line in said.items())]
    )


def _first_line(path: Path) -> str:
    """What a file says of itself; nothing where it is no Python."""
    with suppress(SyntaxError, ValueError):
        return (ast.get_docstring(ast.parse(path.read_bytes())) or "").partition("\n")[0]
    return ""


def _add_compare(commands: Any) -> None:
    compare = commands.add_parser("compare", help="schemes on your own keyframes")
    _add_keyframes(compare, nargs="?")  # it may stand behind the words of --schemes
    _add_schemes(compare)
    _add_option(compare, "of those schemes that have it")
    kept = "take every K-th frame for a keyframe, and measure at the frames left out"
    compare.add_argument("--keep", type=_count, metavar="K", help=kept)
    where = "for tables, figures and the page; by default KEYFRAMES-compared here"
    compare.add_argument("--out", type=Path, metavar="DIR", help=where)
    _add_needs(compare)
    _add_force(compare)


def _add_needs(compare: argparse.ArgumentParser) -> None:
    """What a scheme must have to be recommended."""
    needs = compare.add_argument_group(
        "needs", "Schemes that lack one are not recommended, and are named with what they have."
    )
    needs.add_argument("--smooth", type=int, choices=(0, 1, 2), help="k of C^k, as measured")
    local = "a changed keyframe changes the curve nearby only"
    needs.add_argument("--local", action="store_true", help=local)
    causal = "keyframes after a segment's own two that a curve may wait for"
    needs.add_argument("--causal", type=_frames, metavar="N", help=causal)
    for name, unit in (("rate", "degrees/s"), ("accel", "degrees/s^2")):
        told = f"the largest |{'omega' if name == 'rate' else 'alpha'}|, {unit}"
        needs.add_argument(f"--max-{name}", type=_rate, metavar="DEG", help=told)
    off = "how far the curve may leave the arcs between keyframes, degrees"
    needs.add_argument("--max-excursion", type=_least, metavar="DEG", help=off)
    unit = "what the file's times count, such as ms or '1/30 s'; by default seconds, or what the file says"
    needs.add_argument("--time-unit", type=_unit, metavar="UNIT", help=unit)


def _add_sample(commands: Any) -> None:
    sample = commands.add_parser("sample", help="a scheme's curve through keyframes, sampled")
    _add_keyframes(sample)
    sample.add_argument("--scheme", required=True, metavar="S", help="see quatspline list")
    grid = sample.add_mutually_exclusive_group(required=True)
    grid.add_argument("--rate", type=_rate, metavar="HZ", help="samples per second")
    grid.add_argument(
        "--count", type=_count, metavar="N", help="samples in all, both ends included"
    )
    grid.add_argument("--at", metavar="FILE", help="at the times of another motion file")
    _add_option(sample, "of the scheme")
    signs = "keep the signs of the quaternions, which may go the long way round"
    sample.add_argument("--no-align", dest="align", action="store_false", help=signs)
    held = "the first and last pose outside the keyframes' times"
    sample.add_argument("--hold", action="store_true", help=held)
    along = "how positions go: matched (to the scheme), linear, catmull-rom, cubic, ..."
    sample.add_argument("--positions", default="matched", metavar="FAMILY", help=along)
    sample.add_argument("-o", dest="file", metavar="FILE", help="by default CSV on stdout")


def _add_reduce(commands: Any) -> None:
    reduce = commands.add_parser(
        "reduce", help="the frames of a dense motion from which a scheme rebuilds it"
    )
    _add_file(reduce)
    bound = "the largest angle at a frame left out: 0.5deg, 0.01rad"
    reduce.add_argument("--error", type=_angle, required=True, metavar="ANGLE", help=bound)
    reduce.add_argument("--scheme", default="slerp", metavar="S", help="%(default)s")
    _add_option(reduce, "of the scheme")
    together = "one set of frames for all joints, not one each"
    reduce.add_argument("--together", action="store_true", help=together)
    out = "keyframes by joint (.csv, .npz), or the motion rebuilt at its frames (.bvh, .glb)"
    reduce.add_argument("-o", dest="file", metavar="FILE", help=out)


def _add_info(commands: Any) -> None:
    info = commands.add_parser("info", help="what a motion file is: tracks, rate, gaps, noise")
    _add_file(info)


def _add_motions(commands: Any) -> None:
    motions = commands.add_parser(
        "motions", help="fetch the recorded clips that experiments measure on"
    )
    motions.add_argument(
        "folder", nargs="?", type=Path, default=Path("motions"), metavar="DIR", help="%(default)s"
    )
    mirror = "a folder on the web that has all files by name, instead of their sources"
    motions.add_argument("--from", dest="mirror", metavar="ADDRESS", help=mirror)
    replaced = "replace files of these names that hold something else"
    motions.add_argument("--force", action="store_true", help=replaced)


def _add_report(commands: Any) -> None:
    report = commands.add_parser("report", help="the page that shows the results")
    report.add_argument(
        "--out", type=Path, default=Path("results"), metavar="DIR", help="%(default)s"
    )
    _add_force(report)
    report.add_argument("--open", action="store_true", help="in the browser")


def _add_keyframes(parser: argparse.ArgumentParser, nargs: Literal["?"] | None = None) -> None:
    _add_file(parser, nargs)
    closing = "a closed curve: the last row repeats the first orientation, or times are uniform"
    parser.add_argument("--closed", action="store_true", help=closing)


def _add_file(parser: argparse.ArgumentParser, nargs: Literal["?"] | None = None) -> None:
    kinds = (
        "CSV (t,qw,qx,qy,qz, or columns named in a header), TUM (t tx ty tz qx qy qz qw), EuRoC, "
        "KITTI, NPZ, BVH, AMC, glTF or GLB"
    )
    parser.add_argument("keyframes", metavar="KEYFRAMES", help=kinds, nargs=nargs)
    parser.add_argument(
        "--skip", type=_frames, default=0, metavar="N", help="frames left out first"
    )
    parser.add_argument("--skeleton", metavar="ASF", help="of an AMC; by default the one beside it")
    rate = "of files that do not say (KITTI, AMC), or other than a BVH says"
    parser.add_argument("--frame-rate", type=_rate, metavar="HZ", help=rate)
    gap = "frames farther apart (s) are in pieces, each with a curve of its own"
    parser.add_argument("--max-gap", type=_rate, metavar="S", help=gap)


def _add_schemes(parser: argparse.ArgumentParser) -> None:
    names = "names, by blanks or commas"
    parser.add_argument("--schemes", nargs="+", metavar="S", action="append", help=names)


def _add_option(parser: argparse.ArgumentParser, whose: str) -> None:
    told = f"an option {whose}, may be repeated: see quatspline options S"
    parser.add_argument(
        "--option", dest="options", action="append", default=[], metavar="NAME=VALUE", help=told
    )


def _add_force(parser: argparse.ArgumentParser) -> None:
    replaced = "replace files that quatspline did not write, or that were edited since"
    parser.add_argument("--force", action="store_true", help=replaced)


def _number(kind: type, accepts: Callable[[Any], bool], wanted: str) -> Callable[[str], Any]:
    def parsed(text: str) -> Any:
        with suppress(ValueError):
            if text.isascii() and "_" not in text and accepts(value := kind(text)):
                return value
        raise argparse.ArgumentTypeError(f"{text!r}: {wanted} is expected")

    return parsed


def _angle(text: str) -> float:
    """An angle in rad of a number with its unit."""
    number = text.strip().lower().removesuffix("°")
    unit = "deg" if number != text.strip().lower() else number[-3:]
    number = number.removesuffix(unit)
    with suppress(ValueError):
        value = float(number) * {"deg": math.pi / 180.0, "rad": 1.0}.get(unit, math.nan)
        if 0.0 < value < math.inf:
            return value
    raise argparse.ArgumentTypeError(f"{text!r}: a positive angle with its unit, as 0.5deg")


SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}


def _unit(text: str) -> float:
    """Seconds of a unit of time, of several or of a fraction of one."""
    number, _, name = text.strip().rpartition(" ")
    with suppress(ValueError, ZeroDivisionError):
        seconds = float(Fraction(number or 1)) * SECONDS.get(name, math.nan)
        if 0.0 < seconds < math.inf:
            return seconds
    units = ", ".join(SECONDS)
    raise argparse.ArgumentTypeError(f"{text!r}: one of {units} is expected, or as in '1/30 s'")


_rate = _number(float, lambda value: 0.0 < value < math.inf, "a positive number")
_least = _number(float, lambda value: 0.0 <= value < math.inf, "a number, at least 0,")
MOST = 2**63 - 1
"""Of what is counted: beyond, a number is a slip of the keyboard and fits into no array."""

_count = _number(int, lambda value: 1 <= value <= MOST, "a whole number, at least 1,")
_frames = _number(int, lambda value: 0 <= value <= MOST, "a whole number, at least 0,")
_seed = _number(int, lambda value: value >= 0, "a whole number, at least 0,")
