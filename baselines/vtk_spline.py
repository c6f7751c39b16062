"""VTK's vtkQuaternionInterpolator, spline."""

from __future__ import annotations

from quatspline.peers.vtk import VtkCurve


class VtkSpline(VtkCurve):
    """``vtkQuaternionInterpolator`` with ``SetInterpolationTypeToSpline``, one call per sample.  BSD-3-Clause.

    Documented as "spline interpolation (using SQUAD)" on "the surface of the unit quaternion sphere":
    C^1, interpolating, local (four keyframes shape a segment); the neighbours of both ends are the ends
    themselves.  With two keyframes it is linear [vtk].  Orientations only.
    """

    title = "VTK quaternion interpolator, spline"
    mode = "Spline"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "interior"
    closable = False
    # Of VTK 9.7.2, whose results are no unit quaternions (docs/peers.md).
    departs = {
        "test_keeps_given_signs": "goes the short way",
        "test_continuity_holds": "takes no account of spacings",
        **dict.fromkeys(
            (
                "test_unit_norm",
                "test_hits_its_keyframes",
                "test_equivariance",
                "test_unix_times",
                "test_repeated_keyframes",
                "test_half_turns",
                "test_equivariance_at_half_turns",
                "test_rounded_holds",
                "test_spacing_ratios",
                "test_tiny_steps",
                "test_very_uneven_times",
                "test_constant_rate_is_kept",
                "test_log_is_the_logarithm",
                "test_log_of_a_spin_goes_on",
                "test_interpolates",
                "test_order",
            ),
            "returns no unit quaternions and misses its keyframes",
        ),
    }
