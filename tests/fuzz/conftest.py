# SPDX-License-Identifier: GPL-3.0-or-later
"""Summary of a run."""

import os

import pytest

from fuzz.counting import COUNTS


@pytest.fixture(scope="session", autouse=True)
def counts():
    """Says at the end how many cases each way in has been given, and how many of these it has refused."""
    yield
    path = os.environ.get("RPPM_FUZZ_COUNTS")
    if path:
        with open(path, "a", encoding="utf-8") as file:
            file.writelines(f"{way} {given} {refused}\n" for way, (given, refused) in COUNTS.items())
