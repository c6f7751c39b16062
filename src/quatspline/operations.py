"""Operations: what a scheme executes, whatever the machine.

Those of compiled schemes are counted by running their kernels (`counted`).  A scheme in numpy may state its own,
``operations = Operations(exps=Per(sample=3), logs=Per(keyframe=1))``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Per:
    """How many of one operation each of these takes.

    Attributes
    ----------
    sample : an evaluated orientation
    keyframe : each keyframe of a long set-up; NaN if the set-up is not counted
    iteration : in addition, each keyframe in each update of an iteration

    Examples
    --------
    >>> import quatspline as qs
    >>> qs.scheme("squad").operations.logs
    Per(sample=0, keyframe=7, iteration=0)
    """

    sample: float = 0
    keyframe: float = 0
    iteration: float = 0


NONE = Per()


@dataclass(frozen=True)
class Operations:
    """Counts of operations, by kind.

    Attributes
    ----------
    slerps, exps, logs, roots : roots are square roots, including those inside the other operations
    others : counts of other operations by name

    Examples
    --------
    >>> import quatspline as qs
    >>> quartic = qs.scheme("quartic").operations
    >>> quartic.exps, quartic.logs
    (Per(sample=3, keyframe=0, iteration=0), Per(sample=0, keyframe=1, iteration=0))
    >>> quartic.kinds["multiplications"].sample
    106
    """

    slerps: Per = NONE
    exps: Per = NONE
    logs: Per = NONE
    roots: Per = NONE
    others: Mapping[str, Per] = field(default_factory=dict)

    @property
    def kinds(self) -> dict[str, Per]:
        """All counts by the name of the operation."""
        own = {"slerps": self.slerps, "exps": self.exps, "logs": self.logs, "roots": self.roots}
        return own | dict(self.others)


UNSTATED = Operations()
"""Of a scheme that states nothing, such as a library's."""
