"""The golden numbers of `spec/golden.json`, which independent implementations computed."""

import json
from pathlib import Path

GOLDEN = json.loads((Path(__file__).parent / "data" / "golden.json").read_text())
