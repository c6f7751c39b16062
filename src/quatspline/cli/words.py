"""Words behind ``--schemes``: names of schemes, and what argparse took for one though it was meant otherwise.

An option of several words takes all that follow it, so in ``--schemes a,b FILE`` the file, too.  What
names no scheme and is what the command waits for is given back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from pathlib import Path

Groups = Sequence[Sequence[str]]
"""The words behind each ``--schemes``."""


def names(words: Iterable[str]) -> list[str]:
    """The names in words, which may hold several by commas."""
    return [name for word in words for name in word.split(",") if name]


def apart(
    groups: Groups, meant: Callable[[str], bool], what: str, *, one: bool = False
) -> tuple[list[str], list[str]]:
    """Names of schemes, and the words that mean something else.

    Parameters
    ----------
    groups : words; the first of each names schemes unless it cannot
    meant : whether a word is what the command waits for
    what : what that is called
    one : whether it waits for one, so that once that is found no other word can be meant

    Raises
    ------
    ValueError
        Where a word is a scheme's name and what the command waits for, too.
    """
    placed = [(word, i > 0) for group in groups for i, word in enumerate(group)]
    others = [word for word, _ in placed if meant(word) and not _names_schemes(word)]
    schemes = [word for word, _ in placed if not meant(word) or _names_schemes(word)]
    doubtful = [word for word, later in placed if later and meant(word) and _names_schemes(word)]
    if doubtful and not (one and others):
        raise ValueError(
            f"--schemes ... {doubtful[0]}: both a scheme and {what}: if {what} is meant, put it before --schemes"
        )
    return names(schemes), others


def _names_schemes(word: str) -> bool:
    from quatspline.catalogue import found

    return bool(names([word])) and set(names([word])) <= set(found())


def of_run(experiments: Sequence[str], groups: Groups | None) -> tuple[list[str], list[str] | None]:
    """Experiments and schemes: where no experiment stands before ``--schemes``, words behind it may be some."""
    if groups is None:
        return list(experiments), None
    from quatspline.runs import experiment

    known = {} if experiments else experiment.files()
    schemes, more = apart(groups, known.__contains__, "an experiment")
    return [*experiments, *more], usable(schemes)


def of_compare(keyframes: str | None, groups: Groups | None) -> tuple[str, list[str] | None]:
    """The file of keyframes and the schemes: where no file stands before ``--schemes``, a word behind it is one."""
    if keyframes is not None:
        return keyframes, None if groups is None else usable(names(chain(*groups)))
    schemes, files = apart(groups or (), _is_file, "a file", one=True)
    if len(files) == 1:
        return files[0], usable(schemes)
    if len(files) > 1:
        raise ValueError(f"one file of keyframes is expected, not {len(files)}: {', '.join(files)}")
    _refuse_unknown(schemes)
    raise ValueError("the following arguments are required: KEYFRAMES")


def usable(schemes: Iterable[str]) -> list[str]:
    """Names of schemes, each of which can be used, once."""
    from quatspline.catalogue import scheme

    chosen = [scheme(name).name for name in dict.fromkeys(schemes)]
    if not chosen:
        raise ValueError("--schemes: no name given")
    return chosen


def _refuse_unknown(schemes: Iterable[str]) -> None:
    from quatspline.catalogue import found
    from quatspline.options import nearest

    for name in schemes:
        if name not in found():
            raise ValueError(f"{name!r} is neither a file nor a scheme: {nearest(name, found())}")


def _is_file(word: str) -> bool:
    """Whether a word is a file, or can only be meant as one."""
    path = Path(word)
    return word == "-" or path.is_file() or bool(path.suffix) or len(path.parts) > 1
