# SPDX-License-Identifier: GPL-3.0-or-later
"""What pyproject.toml cannot say: the version is the extension's, and the shaders beside the package go into it."""

import tomllib
from pathlib import Path

from setuptools import find_namespace_packages, setup

MANIFEST = tomllib.loads((Path(__file__).parent / "blender_manifest.toml").read_text(encoding="utf-8"))

setup(
    version=MANIFEST["version"],
    packages=[*find_namespace_packages(include=["rppm_addon*"]), "rppm_addon.shaders"],
    package_dir={"rppm_addon.shaders": "shaders"},
    package_data={
        "rppm_addon": ["**/*.npz"],
        "rppm_addon.shaders": ["**/*.glsl", "**/*.comp", "**/*.vert", "**/*.frag"],
    },
    include_package_data=False,
)
