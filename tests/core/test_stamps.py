"""Times of every kind: differences are taken before anything is rounded."""

import datetime
from typing import Any

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline.inputs import stamps
from walks import apart, walk

NOW = 1_650_000_000_000_000_000
Q = walk(4, 40.0)
STEPS = np.array([0, 100, 350, 1000])
ZONE = datetime.timezone(datetime.timedelta(hours=2))


def kinds() -> dict[str, tuple[Any, float]]:
    """Times a step of STEPS apart, and the length of a step in time units."""
    day = datetime.datetime(2024, 5, 1, 12)
    micro = [datetime.timedelta(microseconds=int(k)) for k in STEPS]
    nano = (NOW + STEPS).astype("datetime64[ns]")
    return {
        "int64": (NOW + STEPS, 1.0),
        "uint64": ((NOW + STEPS).astype(np.uint64), 1.0),
        "int8": (np.array([0, 10, 35, 100], np.int8), 0.1),
        "longdouble": (np.longdouble(1e9) + STEPS.astype(np.longdouble) * 2.0**-30, 2.0**-30),
        "datetime64[ns]": (nano, 1e-9),
        "datetime64[fs]": (STEPS.astype("datetime64[fs]"), 1e-15),
        "datetime64[as]": (STEPS.astype("datetime64[as]"), 1e-18),
        "datetime64[D]": ((STEPS + 19_000).astype("datetime64[D]"), 86_400.0),
        "timedelta64[10us]": (STEPS.astype("timedelta64[10us]"), 1e-5),
        "Series": (pd.Series(nano), 1e-9),
        "DatetimeIndex": (pd.DatetimeIndex(nano), 1e-9),
        "zoned": (pd.Series(nano).dt.tz_localize("Europe/Berlin"), 1e-9),
        "datetimes": ([day + delta for delta in micro], 1e-6),
        "zoned datetimes": ([(day + delta).replace(tzinfo=ZONE) for delta in micro], 1e-6),
        "far datetimes": ([datetime.datetime(3000, 1, 1) + delta for delta in micro], 1e-6),
        "timedeltas": (micro, 1e-6),
        "Timedeltas": ([pd.Timedelta(int(k), "ns") for k in STEPS], 1e-9),
    }


@pytest.mark.parametrize("kind", list(kinds()))
def test_every_kind_of_time_is_the_same_motion(kind: str) -> None:
    times, unit = kinds()[kind]
    curve, wanted = qs.build("kim", times, Q), qs.build("kim", STEPS * unit, Q)
    assert np.allclose(curve.keyframes.spacings, wanted.keyframes.spacings, rtol=4e-16, atol=0.0)
    for order in (0, 1, 2):
        scale = unit**order
        assert apart(curve(times, order) * scale, wanted(STEPS * unit, order) * scale) < 1e-12
    assert np.array_equal(curve(times)[-1], curve(curve.domain[1]))
    assert apart(curve.log(times), wanted.log(STEPS * unit)) < 1e-12
    single = times.iloc[2] if isinstance(times, pd.Series) else times[2]
    assert np.array_equal(curve(single), curve(times)[2])


def test_a_sample_between_two_ticks_counts() -> None:
    curve = qs.build("slerp", NOW + STEPS, Q)
    assert np.array_equal(curve(float(NOW)), curve(NOW))  # NOW is a float64 number
    moments = qs.build("slerp", pd.timedelta_range("0ns", periods=4, freq="3ns"), Q)
    assert moments.since(pd.Timedelta("4ns")) == 4e-9


def test_samples_far_outside_are_outside() -> None:
    """584.5 years are 2^64 ns: no difference wraps around into the domain."""
    start = np.datetime64("2024-01-01", "ns")
    curve = qs.build("slerp", start + STEPS.astype("timedelta64[ms]"), Q)
    for far in ("2608-07-21T23:34:33.709551616", "2608-07-21T23:34:34", "1700-01-01"):
        with pytest.raises(ValueError, match=r"^t = .*outside the domain"):
            curve(np.datetime64(far[:19], "s"))
    for far in (np.int64(-(2**63)), np.int64(2**63 - 1)):
        with pytest.raises(ValueError, match="outside the domain"):
            qs.build("slerp", NOW + STEPS, Q)(far)
    ages = np.array(["1700", "1900", "2000", "2260"], "datetime64[Y]").astype("datetime64[ns]")
    assert qs.build("slerp", ages, Q).keyframes.knots[-1] == 204_535 * 86_400.0


@pytest.mark.parametrize(
    ("times", "sentence"),
    [
        (np.array(["2024", "NaT", "2025", "2026"], "datetime64[D]"), r"^times\[1\] is not a time"),
        (np.array([0, 1, 2, 3], "timedelta64[M]"), r"^times: timedelta64\[M\] has no fixed length"),
        ([datetime.timedelta(k) for k in (0, 1, 2)] + ["x"], r"^times\[3\] = 'x': not a time like"),
        ([datetime.datetime(2024, 1, 1), None, 2, 3], r"^times\[1\] = None: not a time like"),
        (
            [datetime.datetime(2024, 1, 1), datetime.timedelta(1), 2, 3],
            r"^times\[1\] = .*: not a time",
        ),
        (np.array([0, 1, 2, 2**64 - 1], np.uint64), r"^times\[3\] = 18446744073709551615: beyond"),
        (np.longdouble("1e400") * np.arange(1, 5), r"^times"),
        (NOW + np.array([0, 1, 1, 2]), rf"^times\[2\] = {NOW + 1} does not exceed times\[1\]"),
    ],
)
def test_what_is_no_time_is_refused(times: Any, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        qs.build("slerp", times, Q)


@pytest.mark.parametrize("kind", ["datetimes", "zoned", "Series", "timedeltas", "int64"])
def test_samples_outside_are_named_as_given(kind: str) -> None:
    times, _ = kinds()[kind]
    curve = qs.build("slerp", times, Q)
    late = times.iloc[3] if isinstance(times, pd.Series) else times[3]
    late = late + (datetime.timedelta(1) if kind != "int64" else 5)
    with pytest.raises(ValueError, match=r"^t(\[0\])? = .*: outside the domain \["):
        curve(late)
    with pytest.raises(ValueError, match=r"^t(\[1\])? = .*: outside the domain \["):
        curve.since([curve.domain[0], late])


def test_numbers_and_moments_do_not_mix() -> None:
    moments = qs.build("slerp", STEPS.astype("datetime64[s]"), Q)
    with pytest.raises(ValueError, match=r"^t: numbers, but the keyframes' times are datetimes"):
        moments(0)
    with pytest.raises(ValueError, match=r"^t: timedeltas, but the keyframes' times are datetimes"):
        moments(np.timedelta64(5, "s"))
    with pytest.raises(ValueError, match=r"^t: not real numbers"):
        qs.build("slerp", None, Q)(np.datetime64("2024"))
    with pytest.raises(ValueError, match=r"^t is not a time"):
        moments(np.datetime64("NaT"))


def test_coarse_samples_of_the_ends_are_the_ends() -> None:
    curve = qs.build("slerp", [0.1, 0.2, 0.3, 0.7], Q)
    for kind in (np.float16, np.float32):
        assert apart(curve(np.array([0.1, 0.7], kind)), Q[[0, -1]]) < 2e-3
    assert stamps.resolution(0.0, 1e9, np.dtype(np.float16)) == 16.0
    with pytest.raises(ValueError, match="outside the domain"):
        qs.build("slerp", [1e6, 2e6, 3e6, 4e6], Q)(np.float16(2.0))
    with pytest.raises(ValueError, match="not a finite number"):
        curve(np.longdouble("1e400"))


def test_ticks_of_even_times_are_even() -> None:
    """30 Hz in nanoseconds: 33333333, 33333333, 33333334."""
    ticks = np.round(np.arange(4) * 1e9 / 30).astype(np.int64)
    for times in (
        NOW + ticks,
        (NOW + ticks).astype("datetime64[ns]"),
        np.float32(0.1) * np.arange(4),
    ):
        assert qs.build("shoemake-bezier", times, Q).keyframes.uniform
    for times in ([0, 33, 67, 100], NOW + ticks * np.array([1, 1, 1, 2])):
        with pytest.raises(
            ValueError, match=r"^times\[\d\] to times\[\d\] is .*uniform times only"
        ):
            qs.build("shoemake-bezier", times, Q)
