"""A scheme in a package of its own."""

import numpy as np

from quatspline import Curve


class Hold(Curve):
    """Hold each keyframe until the next: not even continuous, but short."""

    title = "Hold"
    reference = "shoemake1985"
    continuity = -1
    order = 1
    support = 1
    constant_rate = "no"
    closable = False

    def _fit(self, keyframes):
        self.q = keyframes.quaternions

    def _orientation(self, t):
        return self.q[np.searchsorted(self.keyframes.knots, t, side="right") - 1]
