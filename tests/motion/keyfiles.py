"""Files of keyframes, and what is said of those that are not taken."""

from pathlib import Path

import pytest

from quatspline.motion.files import MotionFileError, read


def put(folder: Path, name: str, content: str) -> Path:
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


def refusal(path: Path) -> str:
    """What is said of a file, in one line, after its name."""
    with pytest.raises(MotionFileError) as caught:
        read(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    return message.removeprefix(str(path))
