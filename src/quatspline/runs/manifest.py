"""The manifest of a results folder: what was run, and which files in the folder are its own."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from quatspline.system.atomic import ASIDE, check_plain, replacing

MANIFEST = "manifest.json"
SCHEMA = "quatspline results 1"


def read_manifest(folder: Path) -> dict[str, Any]:
    """What the manifest of a folder says; {} where there is none of ours."""
    content = read_json(folder / MANIFEST)
    versions = content.get("versions")  # by which those of the first release are known
    marked = content.get("schema") == SCHEMA or "quatspline" in _object(versions)
    return _shaped(content) if marked else {}


def _shaped(content: dict[str, Any]) -> dict[str, Any]:
    """A manifest with objects where those are due; what is none says nothing."""
    entries = _object(content.get("experiments"))
    experiments = {name: entry for name, entry in entries.items() if isinstance(entry, dict)}
    for entry in experiments.values():
        entry |= {"files": _object(entry["files"])} if "files" in entry else {}
    groups = {name: _object(content[name]) for name in ("files", "claims") if name in content}
    return content | groups | {"experiments": experiments}


def listed(manifest: Mapping[str, Any]) -> dict[str, set[str]]:
    """The SHA-256 under which files are a manifest's own: as they are, and as one was to become."""
    groups = [manifest.get("files", {}), manifest.get("claims", {})]
    groups += [entry.get("files", {}) for entry in manifest.get("experiments", {}).values()]
    own: dict[str, set[str]] = {}
    for name, digest in (item for group in groups for item in group.items()):
        own.setdefault(name, set()).add(str(digest))
    return own


def _object(value: Any) -> dict[str, Any]:
    """A JSON object, {} in place of anything else."""
    return value if isinstance(value, dict) else {}


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
        check_plain(path)
        content = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path}: not a file in JSON: {error}") from error
    if not isinstance(content, dict):
        raise ValueError(f"{path}: a JSON object is expected, found {type(content).__name__}")
    return content


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON file whole, in place of a link rather than through it."""
    with replacing(path, ASIDE, follow=False) as aside:
        aside.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
