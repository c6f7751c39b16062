"""InterpolatePy's SquadC2."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.interpolatepy import InterpolatePyCurve


class InterpolatePySquadC2(InterpolatePyCurve):
    """``interpolatepy.SquadC2``: squad in a parameter that stands still at keyframes.

    Published as C^2 with zero rates at both ends; interpolating, local.  The parameter of every
    segment is the quintic with vanishing derivatives at both of its ends, so the angular velocity is zero
    at every keyframe [interpolatepy; wittmann2023].  Rates by differences, world frame, turned into the
    body frame here; one call per sample.  Open curves only.
    """

    title = "InterpolatePy SquadC2"
    continuity = 2
    order = 1
    support = 4
    constant_rate = "no"
    departs = {
        "test_keeps_given_signs": "its slerps go the short way",
        "test_no_jump_along_a_family_of_keyframes": "its slerps go the short way, between inner quaternions too",
        "test_rates_are_the_curves_own": "takes differences over 1e-6, for accelerations twice",
        "test_time_scale": "takes differences over 1e-6, whatever the unit of time",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from interpolatepy import SquadC2

        self._construct(SquadC2)
