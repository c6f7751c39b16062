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

    Nothing is swapped, dropped or guessed without a word; an option that says nothing of the format is
    refused.  docs/recorded-motion.md tells of each format.

    Parameters
    ----------
    path : the file; its suffix tells the format
    skeleton : the ASF of an AMC; by default the one that it names, or of its own name, beside it
    rate : frames a second where a file has no times or (BVH, AMC) another rate is meant
    times : the same as times in seconds (n,), or a file with one per line
    units : of an AMC's lengths: "cmu" (default) divides by the ASF's unit, "spec" multiplies
    skip : frames to leave out at the start, such as a pose that a converter added
    duplicates : rows that repeat a stamp: "refuse", or keep the "first", the "last", their "mean"
    missing : rows with a number that is blank or nan: "refuse" or "skip"
    max_gap : seconds between frames beyond which the motion is in pieces
    animation : which of a glTF's, by name or index

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
    """Write a motion by the suffix: .bvh, .glb, .tum or .txt, .csv, .npz; EuRoC as .euroc.csv.

    Whole or not at all; text has full precision, BVH six decimals, GLB float32.  A skeleton that a format
    cannot hold is left out with a warning.

    Raises
    ------
    MotionFileError
        Where the format cannot hold the motion, an unknown suffix, a file that cannot be written.

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
