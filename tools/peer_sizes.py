"""What third-party libraries cost, for docs/peers.md: ``python -m tools.peer_sizes``.

For every library that an extra of peers asks for and that is installed: its release, what pip downloads for
it alone and with its dependencies, and what they take on disk.  Dependencies that quatspline has itself do
not count.  Wheels are fetched into a folder that is deleted at the end.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name as plain

EXTRAS = ("peers", "peers-heavy", "peers-drake")
MEGABYTE = 1e6


def requirements(name: str, extra: str = "") -> Iterator[Requirement]:
    """What a distribution asks for here, or one of its extras does besides."""
    for need in map(Requirement, metadata.requires(name) or ()):
        always = need.marker is None or need.marker.evaluate({"extra": ""})
        chosen = need.marker is None or need.marker.evaluate({"extra": extra})
        if chosen and always != bool(extra):
            yield need


def closure(names: Iterable[str]) -> set[str]:
    """Distributions that are installed for some, themselves included."""
    seen: set[str] = set()
    waiting = list(names)
    while waiting:
        name = plain(waiting.pop())
        if name not in seen and installed(name):
            seen.add(name)
            waiting += [need.name for need in requirements(name)]
    return seen


def installed(name: str) -> bool:
    """Whether a distribution is here."""
    try:
        metadata.version(name)
    except metadata.PackageNotFoundError:
        return False
    return True


def on_disk(name: str) -> int:
    """Bytes of a distribution's files."""
    paths = (Path(str(file.locate())) for file in metadata.files(name) or ())
    return sum(path.stat().st_size for path in paths if path.is_file())


def downloads(names: Iterable[str]) -> dict[str, int]:
    """Bytes that pip fetches for each distribution at the version that is installed."""
    releases = [f"{name}=={metadata.version(name)}" for name in sorted(names)]
    with tempfile.TemporaryDirectory() as folder:
        fetch = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", folder]
        subprocess.run([*fetch, *releases], check=True)
        files = list(Path(folder).iterdir())
        return {str(plain(path.name.split("-")[0])): path.stat().st_size for path in files}


def main() -> None:
    """Print a line for every library, and one for every extra."""
    base = closure(need.name for need in requirements("quatspline"))
    peers = {
        extra: [need.name for need in requirements("quatspline", extra) if installed(need.name)]
        for extra in EXTRAS
    }
    needs = {name: closure([name]) - base for names in peers.values() for name in names}
    fetched = downloads(set().union(*needs.values()))
    for extra, names in peers.items():
        for name in names:
            own = fetched[plain(name)] / MEGABYTE
            said = f"{name} {metadata.version(name)}: {own:.2f} MB alone"
            print(f"{said}, {_sizes(needs[name], fetched)}")
        print(f"{extra}: {_sizes(set().union(*(needs[name] for name in names)), fetched)}")


def _sizes(names: set[str], fetched: dict[str, int]) -> str:
    download = sum(fetched[name] for name in names) / MEGABYTE
    disk = sum(map(on_disk, names)) / MEGABYTE
    return f"{download:.2f} MB to download, {disk:.1f} MB on disk"


if __name__ == "__main__":
    main()
