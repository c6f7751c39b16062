"""The arguments of the command line: which there are, and what is said of bad ones."""

from __future__ import annotations

import argparse
import ast
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal, NoReturn

from quatspline import __version__
from quatspline.cli import completion, quantities
from quatspline.system.atomic import naming
from quatspline.system.sentence import MOST as SENTENCE
from quatspline.system.sentence import one_line
from quatspline.system.stdout import STDOUT

REFUSED = 2
"""The status of bad usage and bad input."""


class _Parser(argparse.ArgumentParser):
    """Reports bad usage in one line; its help may end with a closing text."""

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
    whole = _Parser(prog="quatspline", description="A benchmark of orientation interpolation.")
    whole.add_argument("--version", action="version", version=f"quatspline {__version__}")
    commands = whole.add_subparsers(metavar="COMMAND", required=True, dest="name")
    commands.add_parser("list", help="list the schemes and what they claim")
    options = commands.add_parser("options", help="show the options of a scheme")
    known = options.add_argument("scheme", metavar="SCHEME", help="see quatspline list")
    _completed(known, completion.schemes)
    _add_run(commands)
    _add_compare(commands)
    _add_sample(commands)
    _add_reduce(commands)
    _add_info(commands)
    _add_motions(commands)
    _add_report(commands)
    commands.add_parser(
        "warmup", help="compile everything now, so that later commands need not wait"
    )
    return whole


def _add_run(commands: Any) -> None:
    run = commands.add_parser(
        "run",
        help="run experiments: tables, figures and a manifest",
        description="Run experiments. By default all are run, the paper's at full size and the others at quick "
        "size. The same command resumes an interrupted run where it stopped.",
    )
    run.closing = _experiments
    which = run.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help="default: all")
    _completed(which, completion.experiments)
    _add_schemes(run)
    size = run.add_mutually_exclusive_group()
    few, many = "few cases and short rounds", "the sizes that docs and findings quote"
    size.add_argument("--quick", dest="size", action="store_const", const="quick", help=few)
    size.add_argument("--full", dest="size", action="store_const", const="full", help=many)
    out = "folder to write to; default: %(default)s"
    run.add_argument("--out", type=Path, default=Path("results"), metavar="DIR", help=out)
    _add_force(run)
    seed = "seed of random numbers; default: %(default)s"
    run.add_argument("--seed", type=quantities.seed, default=0, metavar="N", help=seed)
    where = run.add_mutually_exclusive_group()
    jobs = "number of processes; default: one per core"
    where.add_argument("--jobs", type=quantities.count, metavar="N", help=jobs)
    dask = "measure on the Dask cluster of this scheduler instead"
    where.add_argument("--dask", metavar="ADDRESS", help=dask)


def _experiments() -> str:
    """Each experiment with the first line of its file; none is loaded."""
    from quatspline.runs.experiment import files

    said = {name: _first_line(path) for name, path in files().items()}
    width = max(map(len, said), default=0)
    return "\n".join(
        ["experiments:", *(f"  {name:{width}}  {line}" for name, line in said.items())]
    )


def _first_line(path: Path) -> str:
    """The first line of a file's docstring; nothing if it is not Python."""
    with suppress(SyntaxError, ValueError):
        return (ast.get_docstring(ast.parse(path.read_bytes())) or "").partition("\n")[0]
    return ""


def _add_compare(commands: Any) -> None:
    compare = commands.add_parser("compare", help="compare schemes on your own keyframes")
    _add_keyframes(compare, nargs="?")  # it may stand behind the words of --schemes
    _add_schemes(compare)
    _add_option(compare, "of those schemes that have it")
    kept = "use every K-th frame as a keyframe, and measure at the frames left out"
    compare.add_argument("--keep", type=quantities.count, metavar="K", help=kept)
    where = (
        "folder for tables, figures and the page; default: KEYFRAMES-compared in the current folder"
    )
    compare.add_argument("--out", type=Path, metavar="DIR", help=where)
    _add_needs(compare)
    _add_force(compare)


def _add_needs(compare: argparse.ArgumentParser) -> None:
    """What a scheme must have to be recommended."""
    needs = compare.add_argument_group(
        "needs",
        "A scheme that fails to meet a need is not recommended, and is listed with its value.",
    )
    smooth = "the curve is C^k with at least this k, as measured"
    needs.add_argument("--smooth", type=int, choices=(0, 1, 2), help=smooth)
    local = "a changed keyframe changes the curve only nearby"
    needs.add_argument("--local", action="store_true", help=local)
    causal = "a segment may wait for at most N keyframes after its own two"
    needs.add_argument("--causal", type=quantities.frames, metavar="N", help=causal)
    for name, unit in (("rate", "degrees/s"), ("accel", "degrees/s^2")):
        told = f"the largest |{'omega' if name == 'rate' else 'alpha'}| allowed, in {unit}"
        needs.add_argument(f"--max-{name}", type=quantities.rate, metavar="DEG", help=told)
    off = "how far the curve may leave the arcs between keyframes, in degrees"
    needs.add_argument("--max-excursion", type=quantities.least, metavar="DEG", help=off)
    unit = "the unit of the file's times, such as ms or '1/30 s'; default: seconds, or what the file says"
    needs.add_argument("--time-unit", type=quantities.unit, metavar="UNIT", help=unit)


def _add_sample(commands: Any) -> None:
    sample = commands.add_parser("sample", help="sample a scheme's curve through keyframes")
    _add_keyframes(sample)
    known = sample.add_argument("--scheme", required=True, metavar="S", help="see quatspline list")
    _completed(known, completion.schemes)
    grid = sample.add_mutually_exclusive_group(required=True)
    grid.add_argument("--rate", type=quantities.rate, metavar="HZ", help="samples per second")
    grid.add_argument(
        "--count",
        type=quantities.count,
        metavar="N",
        help="total number of samples, including both ends",
    )
    grid.add_argument("--at", metavar="FILE", help="sample at the times of another motion file")
    _add_option(sample, "of the scheme")
    signs = "keep the signs of the quaternions; steps may then go the long way round"
    sample.add_argument("--no-align", dest="align", action="store_false", help=signs)
    held = "hold the first and last pose outside the keyframes' times"
    sample.add_argument("--hold", action="store_true", help=held)
    along = "curve for the positions: matched (to the scheme), linear, catmull-rom, cubic, ..."
    sample.add_argument("--positions", default="matched", metavar="FAMILY", help=along)
    out = "file to write; default: CSV on stdout"
    sample.add_argument("-o", dest="file", metavar="FILE", help=out)


def _add_reduce(commands: Any) -> None:
    reduce = commands.add_parser(
        "reduce", help="find the frames of a dense motion from which a scheme rebuilds it"
    )
    _add_file(reduce)
    bound = "the largest angle allowed at a frame left out, such as 0.5deg or 0.01rad"
    reduce.add_argument(
        "--error", type=quantities.angle, required=True, metavar="ANGLE", help=bound
    )
    scheme = "the scheme that rebuilds the motion; default: %(default)s"
    known = reduce.add_argument("--scheme", default="slerp", metavar="S", help=scheme)
    _completed(known, completion.schemes)
    _add_option(reduce, "of the scheme")
    together = "use one set of frames for all joints instead of one per joint"
    reduce.add_argument("--together", action="store_true", help=together)
    out = "file for the keyframes of each joint (.csv, .npz) or for the rebuilt motion (.bvh, .glb)"
    reduce.add_argument("-o", dest="file", metavar="FILE", help=out)


def _add_info(commands: Any) -> None:
    info = commands.add_parser("info", help="describe a motion file: tracks, rate, gaps, noise")
    _add_file(info)


def _add_motions(commands: Any) -> None:
    motions = commands.add_parser(
        "motions", help="download the recorded clips on which experiments measure"
    )
    into = "folder to write to; default: %(default)s"
    motions.add_argument(
        "folder", nargs="?", type=Path, default=Path("motions"), metavar="DIR", help=into
    )
    mirror = "download from this web folder, which has all files by name, instead of the original sources"
    motions.add_argument("--from", dest="mirror", metavar="ADDRESS", help=mirror)
    replaced = "replace files that have these names but different content"
    motions.add_argument("--force", action="store_true", help=replaced)


def _add_report(commands: Any) -> None:
    report = commands.add_parser("report", help="write the page that shows the results")
    out = "folder of the results; default: %(default)s"
    report.add_argument("--out", type=Path, default=Path("results"), metavar="DIR", help=out)
    _add_force(report)
    report.add_argument("--open", action="store_true", help="open the page in the browser")


def _add_keyframes(parser: argparse.ArgumentParser, nargs: Literal["?"] | None = None) -> None:
    _add_file(parser, nargs)
    closing = "make a closed curve; the last row must repeat the first orientation, or times must be uniform"
    parser.add_argument("--closed", action="store_true", help=closing)


def _add_file(parser: argparse.ArgumentParser, nargs: Literal["?"] | None = None) -> None:
    kinds = (
        "CSV (t,qw,qx,qy,qz, or columns named in a header), TUM (t tx ty tz qx qy qz qw), EuRoC, "
        "KITTI, NPZ, BVH, AMC, glTF or GLB"
    )
    parser.add_argument("keyframes", metavar="KEYFRAMES", help=kinds, nargs=nargs)
    parser.add_argument(
        "--skip",
        type=quantities.frames,
        default=0,
        metavar="N",
        help="leave out the first N frames",
    )
    skeleton = "the skeleton of an AMC file; default: the one beside it"
    parser.add_argument("--skeleton", metavar="ASF", help=skeleton)
    rate = "the frame rate of files that do not give one (KITTI, AMC), or to override that of a BVH"
    parser.add_argument("--frame-rate", type=quantities.rate, metavar="HZ", help=rate)
    gap = "split the motion where frames are further apart than this (s); every piece gets its own curve"
    parser.add_argument("--max-gap", type=quantities.rate, metavar="S", help=gap)


def _add_schemes(parser: argparse.ArgumentParser) -> None:
    names = "names of schemes, separated by blanks or commas"
    known = parser.add_argument("--schemes", nargs="+", metavar="S", action="append", help=names)
    _completed(known, completion.listed_schemes)


def _add_option(parser: argparse.ArgumentParser, whose: str) -> None:
    told = f"an option {whose}; may be repeated; see quatspline options S"
    known = parser.add_argument(
        "--option", dest="options", action="append", default=[], metavar="NAME=VALUE", help=told
    )
    _completed(known, completion.options)


def _add_force(parser: argparse.ArgumentParser) -> None:
    replaced = "also replace files that quatspline did not write, or that were edited since"
    parser.add_argument("--force", action="store_true", help=replaced)


def _completed(argument: argparse.Action, completer: Callable[..., list[str]]) -> None:
    """Have shells complete an argument so: argcomplete looks for an attribute of this name."""
    vars(argument)["completer"] = completer
