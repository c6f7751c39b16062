"""The results directory: tables, figures and the manifest."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from quatspline.runs.manifest import MANIFEST, sha256
from quatspline.runs.provenance import now
from quatspline.runs.store import JOURNAL, Store
from quatspline.system.atomic import check_plain

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

__all__ = ["JOURNAL", "MANIFEST", "OUTPUTS", "PAGE", "Results", "markdown", "now"]

PAGE = "report.html"
REPLAYS = ".replay.json"
OUTPUTS = (".csv", ".md", ".png", ".svg", ".caption.txt", REPLAYS, ".error.txt")
"""What an experiment may leave in the folder, after its name."""

CSV_FLOAT = "%.12g"
"""Twelve digits: all that a measurement holds, short of the rounding that machines differ in."""

MARKDOWN_FLOAT = ".4g"
DPI = 300


class Results(Store):
    """A results directory: a `Store` of tables, figures and entries of experiments."""

    def table(
        self,
        name: str,
        frame: pd.DataFrame,
        *,
        title: str = "",
        note: str = "",
        formats: Mapping[str, str] | None = None,
        keys: Sequence[str] | None = None,
        closing: Callable[[pd.DataFrame], str] | None = None,
    ) -> pd.DataFrame:
        """Write a table as ``<name>.csv`` and ``<name>.md``; returns it as read back from the CSV.

        Rows are sorted by ``keys``, by default the columns before the first of floats (all that are
        not floats, if that one leads); rows that tie keep their order.  ``formats`` gives columns
        of the Markdown a format specification; ``closing`` makes of the table as read back what
        follows it there.
        """
        ordered = _ordered(frame, keys)
        csv = ordered.to_csv(index=False, float_format=CSV_FLOAT, lineterminator="\n")
        self.text(f"{name}.csv", csv)
        table = self.read_table(name)
        parts = [f"# {title}" if title else "", note, markdown(ordered, formats)]
        parts.append(closing(table) if closing is not None else "")
        self.text(f"{name}.md", "\n\n".join(part for part in parts if part) + "\n")
        return table

    def read_table(self, name: str) -> pd.DataFrame:
        """A table of this folder; an empty field is missing, any other text is itself.

        Raises FileNotFoundError where there is none, ValueError with the path for what is no table.
        """
        import pandas as pd

        path = self.folder / f"{name}.csv"
        try:
            check_plain(path)
            return pd.read_csv(path, keep_default_na=False, na_values=[""])
        except FileNotFoundError:
            raise
        except (ValueError, OSError) as error:  # pandas tells what is wrong, but not where
            why = error.strerror if isinstance(error, OSError) else error
            raise ValueError(f"{path}: not a table in CSV: {why}") from error

    def figure(self, name: str, figure: Figure) -> None:
        """Write ``<name>.png`` and ``<name>.svg``, the same bytes every time."""
        import matplotlib as mpl

        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # laid out: once, and the same in both files
        undated: dict[str, dict[str, Any]] = {"png": {}, "svg": {"Date": None}}
        for kind, metadata in undated.items():
            # An SVG names its clip paths by salted hashes; without this the salt is random.
            with (
                self.placing(f"{name}.{kind}") as aside,
                mpl.rc_context({"svg.hashsalt": "quatspline"}),
            ):
                figure.savefig(aside, format=kind, dpi=DPI, metadata=metadata)

    def replays(self, name: str, motions: Sequence[Mapping[str, Any]]) -> None:
        """Write motions for the page's player as ``<name>.replay.json``."""
        self.text(f"{name}{REPLAYS}", json.dumps(motions, separators=(",", ":")) + "\n")

    def outputs(self, name: str) -> dict[str, str]:
        """SHA-256 of the files that an experiment has in the folder."""
        own = [f"{name}{end}" for end in OUTPUTS if self.owns(f"{name}{end}")]
        return {file: sha256(self.folder / file) for file in own}

    def tidy(self, name: str) -> None:
        """Remove outputs of an experiment that this run did not write: those of an earlier one."""
        stale = {*self.outputs(name)}
        if self.force:  # what a run that fails writes there, one that does not takes away
            stale.add(f"{name}{OUTPUTS[-1]}")
        for file in stale - self._written:
            (self.folder / file).unlink(missing_ok=True)

    def record(self, name: str, entry: Mapping[str, Any]) -> None:
        """Enter what an experiment did, with the files that it has."""
        self.manifest["experiments"][name] = {**entry, "files": self.outputs(name)}
        self.refresh()


def markdown(frame: pd.DataFrame, formats: Mapping[str, str] | None = None) -> str:
    """A frame as a Markdown table; missing values are empty cells, numbers stand right."""
    import pandas as pd

    def cell(value: Any, name: str) -> str:
        if pd.isna(value):
            return ""
        spec = (formats or {}).get(name, MARKDOWN_FLOAT if isinstance(value, float) else "")
        shown = format(value, spec if isinstance(value, (int, float)) else "")
        return shown.replace("|", "\\|").replace("\n", " ")

    numeric = [pd.api.types.is_numeric_dtype(frame[name]) for name in frame]
    rows = [[str(name) for name in frame], ["---:" if right else "---" for right in numeric]]
    columns = [[cell(value, str(name)) for value in frame[name].tolist()] for name in frame]
    rows += [list(row) for row in zip(*columns, strict=True)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _ordered(frame: pd.DataFrame, keys: Sequence[str] | None) -> pd.DataFrame:
    import pandas as pd

    floats = [pd.api.types.is_float_dtype(kind) for kind in frame.dtypes]
    leading = floats.index(True) if any(floats) else len(floats)
    exact = [str(name) for name, is_float in zip(frame, floats, strict=True) if not is_float]
    chosen = list(keys) if keys is not None else exact[:leading] or exact
    if chosen:
        frame = frame.sort_values(chosen, kind="stable", key=_comparable)
    return frame.assign(**{name: frame[name] + 0.0 for name in frame.columns[floats]})  # no -0


def _comparable(column: pd.Series) -> pd.Series:
    """Numbers and text in one column sort as text."""
    return column.astype(str) if column.dtype == object else column
