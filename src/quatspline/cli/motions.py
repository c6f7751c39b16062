"""The command ``motions``: the recorded clips, fetched into a folder, with whose they are and on which terms."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from quatspline.cli.notes import note
from quatspline.system.stdout import say
from quatspline.trajectories.clips import FOLDER
from quatspline.trajectories.fetching import Remote, Source, fetch, sources


def command(folder: Path, *, mirror: str | None, force: bool) -> int:
    """Serve ``quatspline motions``; 1 where a file is missing in the end.

    Raises
    ------
    ValueError
        See `trajectories.fetching.fetch`.
    """
    say(line for source in sources() for line in _terms(source))
    found = fetch(folder, mirror=mirror, force=force, progress=_bar)
    for failure in found.failures:
        note(failure)
    say([f"{folder}: {len(found.new)} downloaded, {len(found.kept)} already there"])
    if found.failures:
        return 1
    say([f"export {FOLDER}={folder}"])
    return 0


def _terms(source: Source) -> list[str]:
    clips = ", ".join(file.name for file in source.files)
    return [source.name, f"  {clips}", f"  terms: {source.terms}", f"  {source.acknowledgement}"]


def _bar(files: list[Remote]) -> Iterable[Remote]:
    from quatspline.runs.experiment import Run

    return Run(quick=True).progress(files, label="motions")
