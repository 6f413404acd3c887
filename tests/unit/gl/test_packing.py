# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of numbers become the bytes that NumPy makes of them."""

import numpy as np
import pytest

from rppm_addon.gl.buffers.records import Record

NUMBERS = Record("PackedNumbers", size="float", count="uint", step="int")


def by_numpy(**values):
    record = NUMBERS.zeros(1)
    for name, value in values.items():
        record[name] = value
    return record.tobytes()


@pytest.mark.parametrize("size", [0.1, -0.0, np.float32(1e-40), np.float64(1.0) / 3.0, np.inf, 3, True, 1e300])
@pytest.mark.parametrize("count", [0, 7, np.int64(1 << 31), np.uint32(4294967295), True, 2.0])
def test_numbers_are_rounded_as_numpy_rounds_them(size, count):
    values = {"size": size, "count": count, "step": -5}
    with np.errstate(over="ignore"):
        assert NUMBERS.pack(values) == by_numpy(**values)


def test_missing_and_unknown_members_are_named():
    with pytest.raises(KeyError, match=r"missing \['step'\], unknown \['stride'\]"):
        NUMBERS.pack({"size": 0.0, "count": 0, "stride": 1})
