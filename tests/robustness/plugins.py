"""Schemes that are wrong in many ways: what each does at import, in a fit, in a sample, or in cells alone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

SOURCE = '''
import os, signal, sys, threading, time
import numpy as np
from quatspline.curve import Curve
{top}

class Held(Curve):
    """The first keyframe, always."""
    title, reference, interpolates = "Held", "none", False
    continuity, order, support, constant_rate = 0, 0, None, "no"
    def _fit(self, keyframes):
        {fit}
    def _orientation(self, t):
        values = np.tile(self.keyframes.quaternions[0], (len(t), 1))
        {sample}
        return values
'''
CELLS = "if keyframes.count == 4: "
"""Where keyframes are those of the tiny experiments, not those of the trial."""
SEGV = "os.kill(os.getpid(), signal.SIGSEGV)"
NULL = "import ctypes; ctypes.string_at(0)"
HUGE = "self.held = b'x' * (1 << 40)"
CHILD = "os.fork(); time.sleep(600)"


@dataclass(frozen=True)
class Bad:
    """A plug-in; ``reason``: what its rows say, None where it does no harm and has values."""

    reason: str | None
    top: str = ""
    fit: str = "pass"
    sample: str = "pass"

    @property
    def text(self) -> str:
        """Its file."""
        return SOURCE.format(top=self.top, fit=self.fit, sample=self.sample)


GOOD = Bad(None)
TIME, DEATH, CUT = "did not end within", "ended its process", "did not end within its limit"

BAD = {
    "exit": Bad("SystemExit: 3", "sys.exit(3)"),
    "interrupt": Bad("KeyboardInterrupt", "raise KeyboardInterrupt"),
    "base": Bad("BaseException", "raise BaseException('all')"),
    "sleep": Bad(TIME, "time.sleep(600)"),
    "loop": Bad(TIME, "while True: pass"),
    "fork": Bad(TIME, CHILD),
    "end": Bad(DEATH, "os._exit(0)"),
    "end_3": Bad(DEATH, "os._exit(3)"),
    "segv": Bad("SIGSEGV", SEGV),
    "null": Bad("SIGSEGV", NULL),
    "abort": Bad("SIGABRT", "os.abort()"),
    "kill": Bad("SIGKILL", "os.kill(os.getpid(), signal.SIGKILL)"),
    "huge": Bad("MemoryError", "held = b'x' * (1 << 40)"),
    "prints": Bad(None, "print('noise ' * 1000)"),
    "thread": Bad(None, "threading.Thread(target=time.sleep, args=(600,), daemon=True).start()"),
    "syntax": Bad("SyntaxError", "def (:"),
    "missing": Bad("ModuleNotFoundError", "import no_such_module"),
    "deep": Bad("RecursionError", "f = lambda: f()\nf()"),
    "two": Bad("one subclass of Curve expected", "class Other(Curve): pass"),
    "fit_exit": Bad("SystemExit", fit="sys.exit(3)"),
    "fit_loop": Bad(TIME, fit="while True: pass"),
    "fit_segv": Bad("SIGSEGV", fit=SEGV),
    "fit_error": Bad("ZeroDivisionError", fit="1 / 0"),
    "nan": Bad("no unit quaternions: length nan", sample="values[-1] = np.nan"),
    "double": Bad("no unit quaternions: length 2", sample="values *= 2.0"),
    "rounded": Bad("no unit quaternions: length 1.00001", sample="values *= 1.00001"),
    "cell_exit": Bad("SystemExit", fit=CELLS + "sys.exit(3)"),
    "cell_interrupt": Bad("KeyboardInterrupt", fit=CELLS + "raise KeyboardInterrupt"),
    "cell_end": Bad(DEATH, fit=CELLS + "os._exit(0)"),
    "cell_segv": Bad("SIGSEGV", fit=CELLS + SEGV),
    "cell_loop": Bad(CUT, fit=CELLS + "\n            while True: pass"),
    "cell_sleep": Bad(CUT, fit=CELLS + "time.sleep(600)"),
    "cell_huge": Bad("MemoryError", fit=CELLS + HUGE),
    "cell_prints": Bad(None, fit=CELLS + "print('noise ' * 1000); os.write(1, b'noise')"),
}


def write(folder: Path, *names: str) -> None:
    """Put plug-ins into a folder."""
    for name in names:
        (folder / f"{name}.py").write_text(BAD[name].text, encoding="utf-8")
