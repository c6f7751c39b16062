"""``python -m quatspline``."""

import sys

from quatspline.cli import main

sys.exit(main())
