# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip that `make extension` builds."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]


def builder() -> ModuleType:
    """extension/build.py, a script, as a module."""
    specification = importlib.util.spec_from_file_location("extension_build", ROOT / "extension" / "build.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def built_zip(folder: Path) -> Path:
    """The zip, built into a folder; skips the test where its wheels cannot be had."""
    module = builder()
    try:
        (file,) = module.build(folder)
    except module.DownloadError as error:
        pytest.skip(str(error))
    return file
