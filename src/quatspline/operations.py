"""Operations: what a scheme states that it executes, whatever the machine.

A class body reads ``operations = Operations(exps=Per(sample=3), logs=Per(segment=1))``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Per:
    """So many of one operation for each of these.

    Attributes
    ----------
    sample : an evaluated orientation
    keyframe : of the set-up, as all that follow
    inner_keyframe : one with neighbours on both sides; all of a closed curve
    segment, knot : a knot is an end of segments, a closed curve's last being its first again
    solve : whatever the number of keyframes

    Examples
    --------
    >>> import quatspline as qs
    >>> qs.scheme("squad").operations.logs
    Per(sample=0, keyframe=6, inner_keyframe=0, segment=0, knot=0, solve=0)
    """

    sample: float = 0
    keyframe: float = 0
    inner_keyframe: float = 0
    segment: float = 0
    knot: float = 0
    solve: float = 0


NONE = Per()


@dataclass(frozen=True)
class Operations:
    """Counts of operations, by kind.

    Attributes
    ----------
    slerps, exps, logs, roots : roots are square roots
    others : counts of other operations by name
    iteration : what every update of an iteration takes besides; it has no iteration of its own

    Examples
    --------
    >>> import quatspline as qs
    >>> quartic = qs.Operations(exps=qs.Per(sample=3), logs=qs.Per(segment=1))
    >>> quartic == qs.scheme("quartic").operations
    True
    """

    slerps: Per = NONE
    exps: Per = NONE
    logs: Per = NONE
    roots: Per = NONE
    others: Mapping[str, Per] = field(default_factory=dict)
    iteration: Operations | None = None

    def __post_init__(self) -> None:
        if self.iteration is not None and self.iteration.iteration is not None:
            raise ValueError("iteration: an iteration has no iteration of its own")

    @property
    def kinds(self) -> dict[str, Per]:
        """All counts by the name of the operation, those of an iteration apart."""
        own = {"slerps": self.slerps, "exps": self.exps, "logs": self.logs, "roots": self.roots}
        return own | dict(self.others)


UNSTATED = Operations()
"""Of a scheme that states nothing, such as a library's."""
