"""VTK's vtkQuaternionInterpolator, linear."""

from __future__ import annotations

from quatspline.peers.vtk import VtkCurve


class VtkLinear(VtkCurve):
    """``vtkQuaternionInterpolator`` with ``SetInterpolationTypeToLinear``, one call per sample.  BSD-3-Clause.

    Documented as "linear in form (using spherical linear interpolation SLERP)": C^0, interpolating, local
    (two keyframes shape a segment) [vtk].  Orientations only.
    """

    title = "VTK quaternion interpolator, linear"
    mode = "Linear"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_keeps_given_signs": "goes the short way",
        "test_very_uneven_times": "small steps go along the chord as it is: norms off by 1e-8",
    }
