# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m rppm_addon does what the rppm program does."""

import sys

from .cli import main

sys.exit(main())
