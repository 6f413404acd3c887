# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits that Windows is told of a job, with the sizes and places that its documentation gives for 64 bits."""

import ctypes

from rppm_addon.session.client.job_object import ExtendedLimits


def test_limits_lie_where_windows_looks_for_them():
    assert ctypes.sizeof(ExtendedLimits) == 144
    assert ExtendedLimits.basic.size == 64 and ExtendedLimits.transfers.offset == 64
    limits = ExtendedLimits()
    limits.basic.flags = 0x2000
    assert bytes(limits)[16:20] == b"\x00\x20\x00\x00"
