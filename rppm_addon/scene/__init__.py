# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene to be rendered, as plain NumPy dataclasses; no GL, no Blender."""

from .camera import Aperture, Camera, Panorama, PanoramaKind, SphericalStereo, Texels
from .images import Image
from .light_linking import ALL_SETS, LIGHT_SETS, LightLinking
from .lights import UNLIMITED_BOUNCES, Light, LightKind, Mist, World
from .materials import Material
from .meshes import (
    AttributeDomain,
    Instance,
    InstanceArray,
    Mesh,
    MeshAttribute,
    MeshShape,
    Particle,
    ParticleArray,
    RayVisibility,
)
from .motion import CameraMovement, Deformation, Movement, Shutter
from .moving_scene import MovingScene
from .node_graphs import AovOutput, Link, NodeGraph, ShaderNode
from .scene import Scene
from .settings import (
    AccelerationStructure,
    DensityEstimation,
    DirectLight,
    FirstCameraHits,
    FirstPhotonHits,
    Instancing,
    PixelFilter,
    RenderSettings,
)
from .storage.storage import load_scene, save_scene
from .volumes import Volume, VolumeGrid, VolumeMotion

__all__ = [
    "ALL_SETS",
    "LIGHT_SETS",
    "UNLIMITED_BOUNCES",
    "AccelerationStructure",
    "AovOutput",
    "Aperture",
    "AttributeDomain",
    "Camera",
    "CameraMovement",
    "Deformation",
    "DensityEstimation",
    "DirectLight",
    "FirstCameraHits",
    "FirstPhotonHits",
    "Image",
    "Instance",
    "InstanceArray",
    "Instancing",
    "Light",
    "LightKind",
    "LightLinking",
    "Link",
    "Material",
    "Mesh",
    "MeshAttribute",
    "MeshShape",
    "Mist",
    "Movement",
    "MovingScene",
    "NodeGraph",
    "Panorama",
    "PanoramaKind",
    "Particle",
    "ParticleArray",
    "PixelFilter",
    "RayVisibility",
    "RenderSettings",
    "Scene",
    "ShaderNode",
    "Shutter",
    "SphericalStereo",
    "Texels",
    "Volume",
    "VolumeGrid",
    "VolumeMotion",
    "World",
    "load_scene",
    "save_scene",
]
