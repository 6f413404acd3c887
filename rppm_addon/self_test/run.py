# SPDX-License-Identifier: GPL-3.0-or-later
"""Started as a script by Blender, with the report's path and the folders of Python's modules as arguments.

Inside Blender this package is a part of bl_ext, which does not exist here: it is imported by its folder instead.
"""

import os
import sys
from pathlib import Path


def main() -> int:
    """Try the device; returns 0 if all is well."""
    here = Path(__file__).resolve()
    sys.path[:] = [str(here.parents[2]), *(folder for folder in sys.path if Path(folder or ".") != here.parent)]
    sys.path += [folder for folder in sys.argv[2:] if folder not in sys.path]
    from rppm_addon.self_test.report import write_report

    return 0 if write_report(Path(sys.argv[1]), lambda _fraction, _words: None).passed else 1


if __name__ == "__main__":
    status = main()
    # Without tidying up, in which drivers hang or crash.
    sys.stdout.flush()
    os._exit(status)
