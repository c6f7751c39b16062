"""Rates at the nodes of panels, which several integrals over one curve have in common."""

from __future__ import annotations

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.derivatives import closed_forms, rates_since
from quatspline.instruments.panels import POINTS, Panels, gauss
from quatspline.quaternion import FloatArray


class NodeRates:
    """Angular velocity and acceleration of a single-track curve at the nodes of panels.

    Those of a library's curve are kept: nine of its orientations make one of them, and integrals halve the
    same panels.  A closed form is asked again more quickly than looked up.
    """

    def __init__(self, curve: Curve) -> None:
        self.curve = curve
        self._kept: dict[tuple[float, float], FloatArray] | None = (
            None if closed_forms(curve) else {}
        )

    def __call__(self, panels: Panels) -> tuple[FloatArray, FloatArray]:
        """omega and alpha (p, POINTS, 3) in the body frame, rad/t and rad/t^2."""
        if self._kept is None:
            rates = self._measured(panels)
        else:
            rates = self._looked_up(panels, self._kept)
        return rates[..., :3], rates[..., 3:]

    def _looked_up(self, panels: Panels, kept: dict[tuple[float, float], FloatArray]) -> FloatArray:
        keys = list(zip(panels.left.tolist(), panels.width.tolist(), strict=True))
        new = np.array([key not in kept for key in keys], dtype=bool)
        if new.any():
            fresh = self._measured(panels.picked(new))
            kept.update(zip((keys[i] for i in np.flatnonzero(new)), fresh, strict=True))
        return np.array([kept[key] for key in keys])

    def _measured(self, panels: Panels) -> FloatArray:
        """Both rates side by side, (p, POINTS, 6)."""
        rates = rates_since(self.curve, panels.times(gauss()[0]).reshape(-1))
        return np.concatenate(rates, axis=-1).reshape(-1, POINTS, 6)
