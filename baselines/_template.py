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

    # Claims, of the default options, each of them measured by tests/schemes/test_claims.py.  An
    # option that changes one sets it on the instance, in `_fit`: self.order = 3.
    title = "Template"
    reference = "shoemake1985"  # a key of references.bib
    continuity = 0  # k of C^k on the unit sphere
    order = 2  # interior approximation order on smooth motion
    support = 2  # keyframes that shape one segment; None means all
    constant_rate = "no"  # "everywhere", "interior" or "no": is a constant spin reproduced?

    # More of them, with what holds where a class says nothing:
    #   interpolates = True          passes through its keyframes
    #   non_uniform = True           takes uneven times; where False, they are refused before `_fit`
    #   closable = True              has a closed curve; where False, closed=True is refused
    #   lookahead = support / 2 - 1  keyframes after a segment's own two that shape it; None means all
    #   min_keyframes = 2            fewer are refused
    #   iterative = False            solves by iteration, and leaves a `solve_report`
    #   orders = (0, 1, 2)           of what a call offers: orientation, velocity, acceleration
    #   operations = Operations()    counts per sample and keyframe, for tables: quatspline.Operations
    #   practical_keyframes = None   beyond so many, experiments leave it out
    #   rescue = {}                  options that find the curve where the default iteration does not
    #   rough = {}                   options that try a curve sooner and nearly, where many are tried
    #   batched = False              True: `_fit` and the evaluation take all tracks, see SegmentCurve
    #   peer = None                  the third-party distribution that it wraps
    #   departs = {}                 {"test_name": "why a peer fails that check"}

    def _fit(self, keyframes: Keyframes, *, ease: Literal["none", "smooth"] = "none") -> None:
        # Called once per track, when a curve is made: keep on self what evaluation needs.
        # keyframes.quaternions (n, 4) are unit, scalar first, and aligned; .knots are times since
        # the first, (n,) or, closed, (n + 1,); .spacings their differences, one per segment.
        # Keyword-only parameters are the options, checked against their annotations before this.
        # An iterative scheme takes tolerance, max_iterations, stop and on_failure, and ends with
        # self._conclude(SolveReport(...), on_failure): quatspline.solving.
        self.ease = ease
        q = keyframes.quaternions
        # A closed curve returns to `sign` times its first keyframe.
        self.q = np.vstack([q, keyframes.sign * q[:1]]) if keyframes.closed else q

    def _orientation(self, t: FloatArray) -> FloatArray:
        # Called for order 0, and, where the two below are not written, by the stencil that takes
        # their place.  t (m,), m >= 0, in any order, is time since the first keyframe in the user's
        # unit, within the domain, one period if closed.  Returns unit quaternions (m, 4).
        i, u = self.keyframes.locate(t)  # the segment (m,), and 0 <= u <= 1 in it (m,)
        u = u[:, None]
        if self.ease == "smooth":
            u = u * u * (3.0 - 2.0 * u)
        return normalise((1.0 - u) * self.q[i] + u * self.q[i + 1])  # (1)

    # def _velocity(self, t: FloatArray) -> FloatArray:
    #   Called for order 1, t as above.  Returns (m, 3): body frame, 2 vec(Q^-1 Q'), rad per unit of
    #   time; at a keyframe, of the segment that it begins.
    #
    # def _acceleration(self, t: FloatArray) -> FloatArray:
    #   Called for order 2.  Returns (m, 3): the derivative of `_velocity` by time.
    #
    # Without them, one shared numerical fallback serves, and tables mark the scheme "numeric".
