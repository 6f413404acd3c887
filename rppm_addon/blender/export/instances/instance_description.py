# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of instances, read once and placed as often as needed. They hold nothing of Blender's.

Tuples, because frozen dataclasses take several times as long to make.
"""

from typing import NamedTuple

import numpy as np

from ....scene import Instance, LightLinking, Particle, RayVisibility
from ..view_layer.visibility import common_visibility


class Instancer(NamedTuple):
    """An object that multiplies others, and the properties that it passes on to its instances."""

    uid: int
    """session_uid of the object."""
    color: tuple[float, ...]
    """Color and alpha of its instances, which Blender gives them in place of their objects' own."""
    visibility: RayVisibility
    """Rays that see the object itself."""
    layer_visibility: RayVisibility
    """Rays that see it in the view layer, where collections may hide it from the camera."""
    holdout: bool
    """Holdout flag of its instances, in place of their objects' own flags, as in Cycles."""
    shadow_catcher: bool
    light_group: str
    """Light group of instances whose objects have none; "" is none."""
    linking: LightLinking | None
    """Light linking of its instances; None where lights are not linked."""
    has_particles: bool

    @property
    def passed_on(self) -> tuple:
        """All that its instances have of it, which is equal where instancers pass on the same."""
        visibility = int(self.layer_visibility)  # flags of their own take long to hash
        flags = visibility, self.holdout, self.shadow_catcher, self.has_particles
        return self.color, *flags, self.light_group, self.linking


class InstanceDescription(NamedTuple):
    """All members of a scene.Instance that do not change from one placement of an object to the next."""

    mesh: int | None
    """Index into Scene.meshes; None for a curve or the like of which no mesh was made yet."""
    materials: list[int]
    """Index into Scene.materials of each material slot."""
    object_name: str
    object_index: int
    color: tuple[float, ...]
    """The object's color and alpha."""
    random: float
    """Random number of an object that nothing multiplies, 0 to 1."""
    visibility: RayVisibility
    holdout: bool
    shadow_catcher: bool
    attributes: dict[str, tuple[float, ...]]
    """Values of attributes that the object or its instancer has as a whole, by name."""
    light_group: str
    linking: LightLinking | None
    terminator_geometry_offset: float
    terminator_shading_offset: float

    def multiplied_by(self, instancer: Instancer) -> "InstanceDescription":
        """The description of the instances that an instancer has of the described object."""
        return InstanceDescription(
            self.mesh,
            self.materials,
            self.object_name,
            self.object_index,
            instancer.color,
            0.0,
            common_visibility(self.visibility, instancer.layer_visibility),
            instancer.holdout,
            self.shadow_catcher or instancer.shadow_catcher,
            self.attributes,
            self.light_group or instancer.light_group,
            instancer.linking,
            self.terminator_geometry_offset,
            self.terminator_shading_offset,
        )

    def place(
        self,
        matrix: np.ndarray,
        random: float | None = None,
        particle: Particle | None = None,
        attributes: dict[str, tuple[float, ...]] | None = None,
    ) -> Instance:
        """The instance that a matrix places, (4, 4) float64, object to world.

        random: the instance's own random number, 0 to 1; None takes the object's. particle: the particle that the
        instance stands for. attributes: the instance's own values; None takes those of the description.
        """
        return Instance(
            self.mesh,
            matrix,
            self.materials,
            self.object_name,
            self.object_index,
            self.color,
            self.random if random is None else random,
            particle,
            self.visibility,
            self.holdout,
            self.shadow_catcher,
            self.attributes if attributes is None else attributes,
            self.light_group,
            self.linking,
            self.terminator_geometry_offset,
            self.terminator_shading_offset,
        )
