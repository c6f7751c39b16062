"""The results directory: tables, figures, the manifest, and the journal of an interrupted run."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import platform
import subprocess
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quatspline import __version__
from quatspline.atomic import replacing

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MANIFEST = "manifest.json"
PAGE = "report.html"
JOURNAL = ".journal.json"
OUTPUTS = (".csv", ".md", ".png", ".svg", ".caption.txt", ".error.txt")
"""What an experiment may leave in the folder, after its name."""

CSV_FLOAT = "%.12g"
"""Twelve digits: all that a measurement holds, short of the rounding that machines differ in."""

MARKDOWN_FLOAT = ".4g"
DPI = 300
LIBRARIES = ("numpy", "scipy", "numba", "pandas", "matplotlib")


class Results:
    """A results directory.  Every file is written aside and renamed: none is ever half there.

    Attributes
    ----------
    folder : the directory, made if need be (a ValueError tells why it cannot)
    manifest : what `manifest.json` holds; `begin`, `record`, `finish` and `refresh` write it
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ValueError(f"{folder}: no such folder can be made: {error.strerror}") from None
        self.manifest: dict[str, Any] = read_json(self.folder / MANIFEST)
        self._written: set[str] = set()

    # -- files ----------------------------------------------------------------------------------

    def text(self, name: str, content: str) -> Path:
        """Write a text file."""
        with replacing(self._noted(name)) as aside:
            aside.write_text(content, encoding="utf-8", newline="\n")
        return self.folder / name

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
            return pd.read_csv(path, keep_default_na=False, na_values=[""])
        except ValueError as error:  # pandas tells what is wrong, but not where
            raise ValueError(f"{path}: not a table in CSV: {error}") from error

    def figure(self, name: str, figure: Figure) -> None:
        """Write ``<name>.png`` and ``<name>.svg``, the same bytes every time."""
        import matplotlib as mpl

        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # laid out: once, and the same in both files
        undated: dict[str, dict[str, Any]] = {"png": {}, "svg": {"Date": None}}
        for kind, metadata in undated.items():
            # An SVG names its clip paths by salted hashes; without this the salt is random.
            with (
                replacing(self._noted(f"{name}.{kind}")) as aside,
                mpl.rc_context({"svg.hashsalt": "quatspline"}),
            ):
                figure.savefig(aside, format=kind, dpi=DPI, metadata=metadata)

    def outputs(self, name: str) -> dict[str, str]:
        """SHA-256 of the files that an experiment has in the folder."""
        paths = (self.folder / f"{name}{end}" for end in OUTPUTS)
        return {path.name: sha256(path) for path in paths if path.is_file()}

    def sweep(self, name: str) -> None:
        """Remove outputs of an experiment that this run did not write: those of an earlier one."""
        for file in set(self.outputs(name)) - self._written:
            (self.folder / file).unlink()

    def intact(self, files: Mapping[str, str]) -> bool:
        """Whether files are all there with the given SHA-256."""
        paths = {self.folder / name: digest for name, digest in files.items()}
        return all(path.is_file() and sha256(path) == digest for path, digest in paths.items())

    # -- manifest -------------------------------------------------------------------------------

    def begin(self, command: Sequence[str], *, seed: int | None = None, **more: Any) -> None:
        """Open the manifest of a run.  Entries of earlier runs stay while their files do."""
        for aside in self.folder.glob(".*.part"):
            aside.unlink(missing_ok=True)  # of a run that was killed
        earlier = self.manifest.get("experiments") or {}
        kept = {
            name: entry for name, entry in earlier.items() if self.intact(entry.get("files", {}))
        }
        self.manifest = {"command": list(command), "start": now(), "end": None}
        self.manifest |= provenance() | {"seeds": {"seed": seed}} | more | {"experiments": kept}
        self.refresh()

    def record(self, name: str, entry: Mapping[str, Any]) -> None:
        """Enter what an experiment did, with the files that it has."""
        files = self.outputs(name)
        self.manifest["experiments"][name] = {**entry, "files": files}
        self.refresh()

    def finish(self) -> None:
        """Close the manifest of a run."""
        self.manifest["end"] = now()
        self.refresh()

    def refresh(self) -> None:
        """Write the manifest with every file now in the folder (after adding a page, say)."""
        names = sorted(path.name for path in self.folder.iterdir() if path.is_file())
        files = [name for name in names if name != MANIFEST and not name.startswith(".")]
        entries = dict(sorted((self.manifest.get("experiments") or {}).items()))
        sizes = {name: entry["size"] for name, entry in entries.items() if "size" in entry}
        digests = {name: sha256(self.folder / name) for name in files}
        self.manifest |= {"sizes": sizes, "experiments": entries, "files": digests}
        write_json(self.folder / MANIFEST, self.manifest)

    def _noted(self, name: str) -> Path:
        self._written.add(name)
        return self.folder / name


class Journal:
    """What an interrupted run had finished: valid for a run of the same fingerprint only."""

    def __init__(self, results: Results, fingerprint: str) -> None:
        self.results, self.path = results, results.folder / JOURNAL
        found = read_json(self.path)
        same = found.get("fingerprint") == fingerprint
        fresh = {"fingerprint": fingerprint, "start": now(), "finished": {}}
        self.content: dict[str, Any] = found if same else fresh

    def finished(self, name: str) -> dict[str, Any] | None:
        """The entry of an experiment that need not run again: its files are there, unchanged."""
        entry = self.content["finished"].get(name)
        return entry if entry and self.results.intact(entry["files"]) else None

    def add(self, name: str, entry: Mapping[str, Any]) -> None:
        """Note that an experiment has finished."""
        self.content["finished"][name] = dict(entry)
        write_json(self.path, self.content)

    def close(self) -> None:
        """The run is complete: forget."""
        self.path.unlink(missing_ok=True)


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


# -- provenance ---------------------------------------------------------------------------------


def provenance() -> dict[str, Any]:
    """Versions, processor and git revision."""
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {
        "versions": versions(),
        "cpu": {"model": cpu_model(), "cores": os.cpu_count(), "usable": usable},
        "platform": platform.platform(),
        "git": git_revision(),
    }


def versions() -> dict[str, str]:
    """Of Python, this package, the libraries under it and the third-party schemes there are."""
    from quatspline.registry import found

    schemes = (item.scheme for item in found().values())
    peers = {scheme.peer for scheme in schemes if scheme is not None and scheme.peer is not None}
    known = {"python": platform.python_version(), "quatspline": __version__}
    return known | {name: importlib.metadata.version(name) for name in (*LIBRARIES, *sorted(peers))}


def cpu_model() -> str:
    """The processor's name, as far as the system tells."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def git_revision() -> dict[str, Any] | None:
    """Revision of the checkout that this package runs from, and whether it was edited since."""
    root = Path(__file__).resolve().parents[3]
    if not (root / ".git").exists():  # an installed package may lie inside somebody else's checkout
        return None

    def git(*arguments: str) -> str:
        command = ["git", "-C", str(root), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    with suppress(OSError, subprocess.CalledProcessError):
        return {"revision": git("rev-parse", "HEAD"), "dirty": bool(git("status", "--porcelain"))}
    return None


def now() -> str:
    """The time, UTC, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def sha256(path: Path) -> str:
    """SHA-256 of a file."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_json(path: Path) -> dict[str, Any]:
    """The object in a JSON file; {} where there is none that can be read."""
    with suppress(OSError, ValueError):
        return json_object(path)
    return {}


def json_object(path: Path) -> dict[str, Any]:
    """The object in a JSON file; a ValueError with the path for anything else."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{path}: not a file in JSON: {error}") from error
    if not isinstance(content, dict):
        raise ValueError(f"{path}: a JSON object is expected, found {type(content).__name__}")
    return content


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON file whole."""
    with replacing(path) as aside:
        aside.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
