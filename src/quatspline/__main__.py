"""``python -m quatspline``."""

import sys

from quatspline.cli.commands import main

sys.exit(main())
