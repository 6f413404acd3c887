# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels show reports of renders."""

import pytest

from rppm_addon.blender import reports


@pytest.fixture(autouse=True)
def no_reports():
    """Nothing has been rendered."""
    reports.forget()
    yield
    reports.forget()
