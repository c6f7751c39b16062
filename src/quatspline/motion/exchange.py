"""Motion files in and out: `read_motion` and `write_motion`."""

from __future__ import annotations

from pathlib import Path

from numpy.typing import ArrayLike

from quatspline.motion import files
from quatspline.motion.files import Reading
from quatspline.motion.motion import Motion


def read_motion(
    path: str | Path,
    *,
    skeleton: str | Path | None = None,
    rate: float | None = None,
    times: ArrayLike | str | Path | None = None,
    units: str | None = None,
    skip: int = 0,
    duplicates: str = "refuse",
    missing: str = "refuse",
    max_gap: float | None = None,
    animation: str | int | None = None,
) -> Motion:
    r"""Read a recorded motion: .csv, .tum or .txt, .euroc.csv, .kitti, .npz, .bvh, .amc, .gltf, .glb.

    Nothing is silently swapped, dropped or guessed, and an option that does not apply to the format is
    refused.  docs/recorded-motion.md describes each format.

    Parameters
    ----------
    path : the file; its suffix decides the format
    skeleton : the ASF file of an AMC file; by default the one that it names, or one of the same name beside it
    rate : frames per second, for a file without times or (BVH, AMC) to override its rate
    times : instead of rate, times in seconds (n,), or a file with one per line
    units : unit of an AMC's lengths: "cmu" (default) divides by the ASF's unit, "spec" multiplies
    skip : number of frames to leave out at the start, such as a pose that a converter added
    duplicates : what to do with rows that repeat a stamp: "refuse" them, or keep the "first", "last" or "mean"
    missing : what to do with rows that have a blank or nan: "refuse" or "skip"
    max_gap : seconds between frames beyond which the motion is split into pieces
    animation : name or index of the animation of a glTF file

    Returns
    -------
    Motion with quaternions aligned in time.

    Raises
    ------
    MotionFileError
        A `ValueError` of one sentence that names the file and the first line (NPZ: row) at fault.

    Examples
    --------
    >>> import pathlib, tempfile, quatspline as qs
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "keyframes.csv"
    >>> _ = path.write_text("t,qw,qx,qy,qz\n0,1,0,0,0\n0.5,0.8,0.6,0,0\n")
    >>> qs.read_motion(path).times
    array([0. , 0.5])
    """
    reading = Reading(skeleton, rate, times, units, skip, duplicates, missing, max_gap, animation)
    return files.read(path, reading).aligned()


def write_motion(path: str | Path, motion: Motion) -> None:
    """Write a motion in the format of the suffix: .bvh, .glb, .tum or .txt, .csv, .npz; EuRoC as .euroc.csv.

    The file is written completely or not at all.  Text has full precision, BVH six decimals, GLB float32.
    A skeleton that a format cannot hold is left out with a warning.

    Raises
    ------
    MotionFileError
        If the format cannot hold the motion, the suffix is unknown, or the file cannot be written.

    Examples
    --------
    >>> import pathlib, tempfile, numpy as np, quatspline as qs
    >>> motion = qs.Motion(np.array([0.0, 1.0]), np.array([[1.0, 0, 0, 0], [0.8, 0.6, 0, 0]]))
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "out.csv"
    >>> qs.write_motion(path, motion)
    >>> print(path.read_text().splitlines()[1])
    0.0,1.0,0.0,0.0,0.0
    """
    files.write(path, motion)
