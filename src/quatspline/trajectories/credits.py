"""What is to stand beside a recorded clip that is shown: whose it is, and what its owners ask for."""

from __future__ import annotations

import re

from quatspline.trajectories.clips import CONTROLS, OWN
from quatspline.trajectories.fetching import sources

MADE = "Made by this project's generator; nobody recorded it."

FORMS = (r"(cmu_)?\d+_\d+.*\.(amc|bvh)", r"tum_.*")
"""Names that a source gives to all of its clips: who has one of its files may have others."""


def credit(name: str) -> str:
    """The sentence for a clip; nothing for one that somebody brought."""
    if name in (OWN, *CONTROLS):
        return MADE
    form = next((form for form in FORMS if re.fullmatch(form, name.lower())), None)
    owners = (
        f"{source.acknowledgement} Terms: {source.terms}."
        for source in sources()
        if form is not None and any(re.fullmatch(form, file.name) for file in source.files)
    )
    return next(owners, "")
