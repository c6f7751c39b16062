"""What the scheme is, in one line.  The file's name is the scheme's: my_scheme.py is my-scheme."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray, normalise


class Template(Curve):
    """Normalised linear interpolation: proper name, author (year), acronym.

    C^0, interpolating, local (two keyframes shape a segment):

        Q(u) = ((1 - u) q_i + u q_{i+1}) / |(1 - u) q_i + u q_{i+1}|                             (1)
    """

    # Claims, each of them measured by tests/schemes/test_claims.py.
    title = "Template"
    reference = "shoemake1985"  # a key of references.bib
    continuity = 0  # k of C^k on the unit sphere
    order = 2  # interior approximation order on smooth motion
    support = 2  # keyframes that shape one segment; None means all
    constant_rate = "no"  # "everywhere", "interior" or "no": is a constant spin reproduced?

    def _fit(self, keyframes: Keyframes, *, ease: Literal["none", "smooth"] = "none") -> None:
        # Called once for each track, with keyframes validated, unit and aligned.  Keyword-only
        # parameters are the options; their annotations are checked before this is called.
        self.ease = ease
        q = keyframes.quaternions
        # A closed curve returns to `sign` times its first keyframe.
        self.q = np.vstack([q, keyframes.sign * q[:1]]) if keyframes.closed else q

    def _orientation(self, t: FloatArray) -> FloatArray:
        # t (m,) is time since the first keyframe, within the domain, one period if closed.
        i, u = self.keyframes.locate(t)  # the segment, and 0 <= u <= 1 in it
        u = u[:, None]
        if self.ease == "smooth":
            u = u * u * (3.0 - 2.0 * u)
        return normalise((1.0 - u) * self.q[i] + u * self.q[i + 1])  # (1)

    # Write `_velocity(t)` and `_acceleration(t)`, body frame (m, 3), if you have them; without
    # them the shared numerical fallback serves, and tables mark the scheme "numeric".
