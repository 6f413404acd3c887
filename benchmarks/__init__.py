# SPDX-License-Identifier: GPL-3.0-or-later
"""Benchmarks that make bench-... runs."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
"""The checkout."""

# They render scenes of the tests, whose modules find each other by name.
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/gl"), str(ROOT / "tests/gl/acceleration")]
