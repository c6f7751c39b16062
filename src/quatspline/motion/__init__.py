"""Recorded motion: files of every format, skeletons, curves through frames, reductions to keyframes."""

from quatspline.motion.errors import MotionFileError, MotionFileWarning
from quatspline.motion.exchange import read_motion, write_motion
from quatspline.motion.motion import Motion
from quatspline.motion.motion_curve import MotionCurve
from quatspline.motion.reducing import Reduction
from quatspline.motion.skeleton import Skeleton

__all__ = [
    "Motion",
    "MotionCurve",
    "MotionFileError",
    "MotionFileWarning",
    "Reduction",
    "Skeleton",
    "read_motion",
    "write_motion",
]
