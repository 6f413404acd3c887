# SPDX-License-Identifier: GPL-3.0-or-later
"""How long to look for what breaks RPPM: a few cases in the tests, always the same; `make fuzz` many, always others."""

import os

import hypothesis
import pytest

from fuzz.counting import COUNTS

EXAMPLES = int(os.environ.get("RPPM_FUZZ_EXAMPLES", "0"))
_COMMON = {
    "deadline": 10_000,  # milliseconds: what takes longer hangs
    "suppress_health_check": list(hypothesis.HealthCheck),
    "print_blob": True,
    "phases": [phase for phase in hypothesis.Phase if phase is not hypothesis.Phase.explain],
}
hypothesis.settings.register_profile("tests", derandomize=True, database=None, max_examples=40, **_COMMON)
hypothesis.settings.register_profile("fuzz", max_examples=max(EXAMPLES, 1), **_COMMON)
hypothesis.settings.load_profile("fuzz" if EXAMPLES else "tests")


@pytest.fixture(scope="session", autouse=True)
def counts():
    """Says at the end how many cases each way in has been given, and how many of these it has refused."""
    yield
    path = os.environ.get("RPPM_FUZZ_COUNTS")
    if path:
        with open(path, "a", encoding="utf-8") as file:
            file.writelines(f"{way} {given} {refused}\n" for way, (given, refused) in COUNTS.items())
