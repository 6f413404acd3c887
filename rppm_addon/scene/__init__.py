# SPDX-License-Identifier: GPL-3.0-or-later
"""What is to be rendered, as plain NumPy dataclasses; no GL, no Blender."""

from .camera import Aperture, Camera, Panorama, PanoramaKind
from .images import Image
from .lights import Light, LightKind, World
from .materials import Lobe, LobeKind, Material
from .meshes import Instance, Mesh
from .scene import Scene
from .settings import DirectLight, RenderSettings
from .storage import load_scene, save_scene

__all__ = [
    "Aperture",
    "Camera",
    "DirectLight",
    "Image",
    "Instance",
    "Light",
    "LightKind",
    "Lobe",
    "LobeKind",
    "Material",
    "Mesh",
    "Panorama",
    "PanoramaKind",
    "RenderSettings",
    "Scene",
    "World",
    "load_scene",
    "save_scene",
]
