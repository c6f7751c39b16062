"""Admission of plug-ins: a file of schemes that does not come with the package is tried before it is imported.

It is imported in a process of its own, and its scheme builds and samples one short curve there.  What that
process does not survive, within limits of time and memory, is not imported here: its scheme is one that
cannot be used, with the reason.  So is one whose orientations are no unit quaternions.  Errors are none of this
module's business: they are raised here, too, and told by whoever imports or builds.

The verdict on a content is remembered in this process and in the cache folder, and handed to workers.
"""

from __future__ import annotations

import faulthandler
import hashlib
import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from importlib import metadata
from pathlib import Path

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.engines import engine
from quatspline.inputs.arrays import FloatArray
from quatspline.system import limits
from quatspline.system.atomic import replacing
from quatspline.system.caching import cache_base
from quatspline.system.ending import beside, bind_to, ended_by

Plugin = Path | metadata.EntryPoint

UNIT = 1e-6
"""How far a length may be off 1: what is off by more is no rounding of float64."""
KEYFRAMES = 6
"""Of the curve that is tried, where a scheme does not ask for more."""
GRACE = 5.0
"""Seconds after its limit in which a process that nobody ended ends itself."""
TRIED = "tried"
"""The folder of verdicts in that of the cache."""
LARGEST = 2**21
"""Bytes of a file of schemes: Python takes up to 260 times as many to compile it."""
PENDING = "it is being tried before it is imported"
"""Why a plug-in cannot be used by another that is tried itself."""

_verdicts: dict[str, str | None] = {}
"""Why a content is not imported, None where it may be, by its digest."""
_on_trial = False
"""Whether this process is one in which a plug-in is tried."""


def verdicts() -> dict[str, str | None]:
    """What this process knows, for others to `take`."""
    return dict(_verdicts)


def take(known: Mapping[str, str | None]) -> None:
    """Believe another process, which has tried what this one would try."""
    _verdicts.update(known)


def refusals(plugins: Sequence[Plugin]) -> dict[Plugin, str]:
    """Why some plug-ins are not to be imported; new ones are tried, side by side."""
    unread = {plugin: why for plugin in plugins if (why := _no_source(plugin)) is not None}
    digests = {plugin: _digest(plugin) for plugin in plugins if plugin not in unread}
    new = [plugin for plugin, digest in digests.items() if _remembered(digest) is Ellipsis]
    if new and _on_trial:
        return unread | dict.fromkeys(new, PENDING)
    if new:
        with ThreadPoolExecutor(min(len(new), os.cpu_count() or 1)) as pool:
            for plugin, verdict in zip(new, pool.map(_tried, new), strict=True):
                _remember(digests[plugin], verdict)
    found = {plugin: _verdicts.get(digest) for plugin, digest in digests.items()}
    return unread | {plugin: verdict for plugin, verdict in found.items() if verdict is not None}


def _no_source(plugin: Plugin) -> str | None:
    """Why what is at a path cannot be a file of schemes: to open a pipe or a device may never end."""
    with suppress(OSError):  # why it cannot be looked at is told when it is imported
        there = isinstance(plugin, Path) and plugin.stat()
        if there and not stat.S_ISREG(there.st_mode):
            return "it is no file"
        if there and there.st_size > LARGEST:
            return f"it has {there.st_size:,} bytes: a file of schemes has {LARGEST:,} at most"
    return None


# -- what is remembered -------------------------------------------------------------------------


def _digest(plugin: Plugin) -> str:
    """A hash of what is tried: the file, private modules beside it, Python and the limits."""
    parts = [sys.version.encode(), repr(limits.seconds(limits.TRIAL_SECONDS)).encode()]
    if isinstance(plugin, Path):
        for path in [plugin, *sorted(plugin.parent.glob("_*.py"))]:
            with suppress(OSError):  # a file that cannot be read is told when it is imported
                parts += [b"" if _no_source(path) else path.read_bytes()]
    else:
        dist = plugin.dist
        parts += [repr((dist and dist.name, dist and dist.version, plugin.value)).encode()]
    return hashlib.sha256(b"\0".join(hashlib.sha256(part).digest() for part in parts)).hexdigest()


def _place(digest: str) -> Path:
    return cache_base() / TRIED / digest


def _remembered(digest: str) -> object:
    """The verdict on a content; Ellipsis where there is none, or none that is whole."""
    if digest in _verdicts:
        return _verdicts[digest]
    with suppress(OSError, ValueError):
        checksum, body = _place(digest).read_text(encoding="utf-8").split("\n", 1)
        if checksum == _sum(digest, body):
            _verdicts[digest] = json.loads(body)
            return _verdicts[digest]
    return Ellipsis


def _remember(digest: str, verdict: str | None) -> None:
    _verdicts[digest] = verdict
    body = json.dumps(verdict)
    with suppress(OSError):  # then the next process tries again
        _place(digest).parent.mkdir(parents=True, exist_ok=True)
        with replacing(_place(digest)) as aside:
            aside.write_text(f"{_sum(digest, body)}\n{body}", encoding="utf-8")


def _sum(digest: str, body: str) -> str:
    return hashlib.sha256(f"{digest}\n{body}".encode()).hexdigest()


# -- the trial, from outside --------------------------------------------------------------------


def _tried(plugin: Plugin) -> str | None:
    """Try a plug-in in a process of its own and return why it is refused."""
    most = limits.seconds(limits.TRIAL_SECONDS)
    place = ["file", str(plugin)] if isinstance(plugin, Path) else ["entry", plugin.name]
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        said = Path(folder) / "verdict"
        process = _started([str(said), str(os.getpid()), str(most), *place])
        try:
            status = process.wait(most)
        except subprocess.TimeoutExpired:
            return f"it did not end within {most:g} s when it was tried"
        finally:
            _end(process)
        if said.exists():
            verdict: str | None = json.loads(said.read_text(encoding="utf-8"))
            return verdict
    return f"it ended its process when it was tried: {ended_by(status)}"


def _started(arguments: Sequence[str]) -> subprocess.Popen[bytes]:
    code = "from quatspline import admission, discovery; admission.main(discovery.loaded)"
    paths = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,  # what it prints it prints again where it is used
        stderr=subprocess.DEVNULL,
        env={**os.environ, **paths, engine.VARIABLE: "python"},
        start_new_session=True,
    )
    beside.add(process)
    return process


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and those that it started."""
    with suppress(OSError, AttributeError):  # there are no groups on Windows
        os.killpg(process.pid, signal.SIGKILL)
    process.kill()
    process.wait()
    beside.discard(process)


# -- the trial, from inside ---------------------------------------------------------------------


def main(load: Callable[[str, str], type[Curve]]) -> None:
    """Try the plug-in that the command line names, as loaded, and write the verdict."""
    global _on_trial
    _on_trial = True
    said, parent, most, kind, name = sys.argv[1:]
    limits.hold_memory(min(limits.TRIAL_MEMORY, limits.memory()))
    silent = open(os.devnull, "w")  # noqa: SIM115 (for as long as the process)
    # Code that never returns to Python lets no thread of Python run; this one is C's.
    faulthandler.dump_traceback_later(float(most) + GRACE, exit=True, file=silent)
    bind_to(int(parent))
    verdict = _verdict(lambda: load(kind, name))
    with replacing(Path(said)) as aside:
        aside.write_text(json.dumps(verdict), encoding="utf-8")
    os._exit(0)  # whatever it registered for the end


def _verdict(load: Callable[[], type[Curve]]) -> str | None:
    try:
        return _flaw(load())
    except MemoryError as error:
        return f"MemoryError: {error}"
    except Exception:  # the same will be raised where it is used
        return None
    except BaseException as error:
        return f"{type(error).__name__}: {error}"


def _flaw(scheme: type[Curve]) -> str | None:
    """What is wrong with the orientations of a short curve."""
    count = max(KEYFRAMES, scheme.min_keyframes)
    curve = scheme(None, quaternion.exp(np.outer(np.linspace(0.0, 2.0, count), (0.3, 0.4, 0.5))))
    t = np.linspace(0.0, count - 1.0, 4 * count + 1)
    if (flaw := no_unit(curve, t)) is not None:
        return flaw
    for order in curve.orders:  # rates may be wrong; they have to end
        curve(t, order)
    return None


def no_unit(curve: Curve, t: FloatArray) -> str | None:
    """What is wrong with the lengths of a curve's orientations; None where they are units."""
    lengths = np.linalg.norm(curve(t), axis=-1)
    off = np.argwhere(~(np.abs(lengths - 1.0) <= UNIT))  # NaN is off, too
    if not len(off):
        return None
    where = f"length {lengths[tuple(off[0])]:.6g} at t = {t[off[0, 0]]:g}"
    return f"its orientations are no unit quaternions: {where}"
