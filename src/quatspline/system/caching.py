"""Where compiled code is kept between processes."""

from __future__ import annotations

import os
from pathlib import Path

VARIABLE = "QUATSPLINE_CACHE"


def cache_base() -> Path:
    """The folder that ``QUATSPLINE_CACHE`` names, or this user's for caches."""
    given = os.environ.get(VARIABLE)
    if given:
        return Path(given)
    import platformdirs

    return Path(platformdirs.user_cache_dir("quatspline"))
