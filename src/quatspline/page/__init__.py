"""The page: one self-contained file that shows a results folder.  It reads tables and measures nothing."""

from __future__ import annotations

import webbrowser
from collections.abc import Sequence
from pathlib import Path

from quatspline.findings.findings import Finding
from quatspline.page.document import document
from quatspline.page.folder import Folder, existing
from quatspline.page.motion import Scene, own_scene, paper_scenes
from quatspline.page.sections import SECTIONS, Section
from quatspline.runs.results import PAGE, Results
from quatspline.system.stdout import say

__all__ = ["PAGE", "Scene", "Section", "command", "own_scene", "paper_scenes", "write_page"]

TITLE = "Orientation interpolation, measured"


def command(results_folder: str | Path, *, open_it: bool = False, force: bool = False) -> int:
    """Serve ``quatspline report``: write the page of a results folder; open it in the browser if asked.

    Raises
    ------
    ValueError
        The folder is not there, holds no table, is being written or has a page that is not its own.
    """
    path = write_page(results_folder, force=force)
    say([str(path)])
    if open_it:
        webbrowser.open(path.resolve().as_uri())
    return 0


def write_page(
    folder: str | Path | Results,
    *,
    force: bool = False,
    title: str = TITLE,
    scenes: Sequence[Scene] | None = None,
    sections: Sequence[Section] = SECTIONS,
    findings: Sequence[Finding] | None = None,
) -> Path:
    """Write ``report.html`` into a folder of tables and enter it in the manifest there.

    Parameters
    ----------
    folder : with the tables, figures and manifest of a run; `Results` where its writer asks
    force : whether a page or a manifest that is not the folder's own may be replaced
    title : the page's heading
    scenes : motions for the player, by default the paper's two cases; see `own_scene`
    sections : what the page shows, in order; tables that none names come last
    findings : the sentences at the top, by default those that the tables support

    Raises
    ------
    ValueError
        The folder is not there, holds no table, is being written or has a page that is not its own.
    """
    results = folder if isinstance(folder, Results) else Results(existing(folder), force=force)
    shown = paper_scenes() if scenes is None else scenes
    with results.writing():
        found = Folder(results.folder)
        results.guard([PAGE])
        html = document(found, title=title, scenes=shown, parts=sections, said=findings)
        results.refresh()  # a folder of tables alone gets a manifest by which its page is known
        results.text(PAGE, html)
        results.refresh()
    return results.folder / PAGE
