"""Sections of pages that `quatspline compare` writes of a user's own keyframes and motions."""

from __future__ import annotations

from dataclasses import replace

from quatspline.page.plots import Plot
from quatspline.page.sections import SECTIONS, Section

_BLOCKS = {section.key: section for section in SECTIONS}

OWN: tuple[Section, ...] = (
    Section(
        "compare",
        "Schemes compared",
        "One row per scheme on these keyframes. Sort by any column; the line above the table states the criterion.",
        ("compare",),
        (
            Plot(
                "compare",
                ("seconds_per_sample", "seconds_set_up"),
                ("torque_over_least", "jerk_over_least", "peak_over_least"),
                "points",
                log=(True, True),
                ratios=("torque_over_least", "jerk_over_least"),
            ),
        ),
    ),
    replace(_BLOCKS["recorded"], tables=(), plots=()),
    *(_BLOCKS[key] for key in ("motions", "log-curves", "rates")),
)
"""The sections of a page for a user's own keyframes."""

KEPT: tuple[Section, ...] = (
    Section(
        "kept",
        "Schemes compared",
        "One row per scheme, measured at the frames left out. Sort by any column; the line above the table states the "
        "criterion.",
        ("kept", "joints"),
        (
            Plot(
                "kept",
                ("seconds",),
                ("rms_median", "rms_worst", "largest", "end_rms"),
                "points",
                log=(True, True),
            ),
        ),
    ),
    replace(_BLOCKS["recorded"], tables=(), plots=()),
)
"""The sections of a page for a user's own skeleton."""
