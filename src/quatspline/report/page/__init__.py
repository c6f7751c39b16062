"""The page: one self-contained file that shows a results folder.  It reads tables and measures nothing."""

from __future__ import annotations

import webbrowser
from collections.abc import Sequence
from pathlib import Path

from quatspline.report.findings import Finding
from quatspline.report.page.document import document
from quatspline.report.page.folder import Folder
from quatspline.report.page.motion import Scene, own_scene, paper_scenes
from quatspline.report.page.sections import SECTIONS, Section
from quatspline.report.results import MANIFEST, PAGE, Results

__all__ = ["PAGE", "Scene", "Section", "command", "own_scene", "paper_scenes", "write_page"]

TITLE = "Orientation interpolation, measured"


def command(results_folder: str | Path, *, open_it: bool = False) -> int:
    """Serve ``quatspline report``: write the page of a results folder; open it in the browser if asked.

    Raises
    ------
    ValueError
        The folder is not there or holds no table.
    """
    path = write_page(results_folder)
    print(path)
    if open_it:
        webbrowser.open(path.resolve().as_uri())
    return 0


def write_page(
    folder: str | Path,
    *,
    title: str = TITLE,
    scenes: Sequence[Scene] | None = None,
    sections: Sequence[Section] = SECTIONS,
    findings: Sequence[Finding] | None = None,
) -> Path:
    """Write ``report.html`` into a folder of tables and enter it in the manifest there.

    Parameters
    ----------
    folder : with the tables, figures and manifest of a run
    title : the page's heading
    scenes : motions for the player, by default the paper's two cases; see `own_scene`
    sections : what the page shows, in order; tables that none names come last
    findings : the sentences at the top, by default those that the tables support

    Raises
    ------
    ValueError
        The folder is not there or holds no table.
    """
    found = Folder(Path(folder))
    results = Results(folder)
    shown = paper_scenes() if scenes is None else scenes
    path = results.text(
        PAGE, document(found, title=title, scenes=shown, parts=sections, said=findings)
    )
    if (results.folder / MANIFEST).is_file():
        results.refresh()
    return path
