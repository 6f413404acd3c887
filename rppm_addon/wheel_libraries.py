# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Windows finds the libraries that wheels bring for their modules."""

import os
import sys
from collections.abc import Iterable
from pathlib import Path


def add_wheel_libraries(folders: Iterable[str]) -> None:
    """Have Windows look where Blender 4.2 leaves them, which unpacks wheels as they are: what belongs beside modules is
    in NAME.data/platlib. Later versions move it, as pip does. Without effect on other systems.

    folders: those of Python's modules.
    """
    if sys.platform == "win32":
        for folder in filter(os.path.isabs, folders):
            for place in Path(folder).glob("*.data/platlib"):
                os.add_dll_directory(str(place))
