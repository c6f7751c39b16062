"""What is to stand beside a recorded clip that is shown: whose it is, and what its owners ask for."""

from __future__ import annotations

import re

from quatspline.trajectories.clips import CONTROLS, OWN

CMU = (
    "The data used in this project was obtained from mocap.cs.cmu.edu. "
    "The database was created with funding from NSF EIA-0196217."
)
TUM = "From the TUM RGB-D benchmark (Sturm et al., 2012), CC BY 4.0."
MADE = "Made by this project's generator; nobody recorded it."

OWNERS: dict[str, str] = {r"(cmu_)?\d+_\d+.*\.(amc|bvh)": CMU, r"tum_.*": TUM}
"""By the names that the clips have at their sources."""


def credit(name: str) -> str:
    """The sentence for a clip; nothing for one that somebody brought."""
    if name in (OWN, *CONTROLS):
        return MADE
    return next((said for form, said in OWNERS.items() if re.fullmatch(form, name.lower())), "")
