# SPDX-License-Identifier: GPL-3.0-or-later
"""python -m rppm_addon.watched is the rppm program for as long as a farm's worker holds its standard input."""

import sys

from .cli import main
from .commands.farm.watchdog import watch_parent

_LINE_SECONDS = 0.5
"""The worker reads how far the render is."""

if __name__ == "__main__":
    watch_parent()
    sys.exit(main(line_seconds=_LINE_SECONDS))
