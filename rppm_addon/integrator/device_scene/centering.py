# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes far from the world's origin, brought near the device's.

A float32 has steps of 2 mm at 20 km and of 6 cm at 1,000 km, which matrices in double precision need not have. So the
world's coordinates, before they become float32, are counted from a place near what the camera sees; nodes and passes
that show them add it again (Scene.world_origin). Where that place is follows from the scene alone, so that a frame has
the same bits in whatever order frames are rendered, and for a scene around the origin it is the origin.
"""

import dataclasses
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from ...scene.camera import Camera
from ...scene.lights import Light, LightKind
from ...scene.meshes import DicingView, Instance
from ...scene.motion import CameraMovement, Movement, Shutter
from ...scene.scene import Scene
from ...scene.storage.sharing import changed_members, same_members
from ..common.instance_columns import column
from ..surfaces.geometry import finite_bounds
from ..surfaces.placements import FARTHEST, placed_boxes

CELL = 256.0
"""Meters between places to count from: within half of it coordinates have steps of less than 8 micrometers."""


_AT_ONCE = 1 << 15
"""Instances that are looked at together."""
_OTHERS = operator.attrgetter(*(member.name for member in dataclasses.fields(Instance)[2:]))
"""All that an instance says but its mesh and its matrix, which come first."""


class Centering:
    """Centered scenes, which share their members as the scenes do that they are made of."""

    def __init__(self) -> None:
        self._origin = np.zeros(3)
        self._made: dict[int, tuple[Any, Any]] = {}
        """Centered members by the id of the members they were made of, which these keep theirs."""
        self._instances: tuple[list[Instance], list[Instance]] = [], []
        """Instances of the scene before, and the same centered."""
        self._bounds = SceneBounds()

    def centered(self, scene: Scene) -> Scene:
        """The scene with its places counted from Scene.world_origin; itself where that is the world's origin.

        Suns stay, as they have no place, and so do particles, whose places only nodes ask for.
        """
        origin = self._origin_of(scene)
        if not origin.any():
            self._made, self._instances = {}, ([], [])
            return scene
        if not np.array_equal(origin, self._origin):
            self._origin, self._made, self._instances = origin, {}, ([], [])
        before, self._made = self._made, {}

        def once(member: Any, make: Callable[[Any], Any]) -> Any:
            made = self._made[id(member)] = before.get(id(member)) or (member, make(member))
            return made[1]

        def moved(member: Light) -> Light:
            return dataclasses.replace(member, matrix=_shifted(member.matrix, origin))

        def shutter_of(shutter: Shutter | None) -> Shutter | None:
            return None if shutter is None else once(shutter, lambda it: _shifted_shutter(it, scene, origin))

        center = scene.cubemap_center
        return dataclasses.replace(
            scene,
            world_origin=scene.world_offset + origin,
            camera=once(scene.camera, lambda camera: _shifted_camera(camera, origin)),
            dicing_view=once(scene.dicing_view, lambda view: _shifted_view(view, origin)),
            instances=self._centered_instances(scene.instances, origin),
            lights=[light if light.kind is LightKind.SUN else once(light, moved) for light in scene.lights],
            cubemap_center=None if center is None else once(center, lambda place: np.asarray(place) - origin),
            shutter=shutter_of(scene.shutter),
            neighbors=shutter_of(scene.neighbors),
        )

    def _origin_of(self, scene: Scene) -> np.ndarray:
        """(3,) meters, on a grid that float32 has exactly: by the place of the scene nearest to the camera.

        A camera far from all it sees says nothing of where fine coordinates are needed.
        """
        texels = scene.camera.texels
        if texels is not None and texels.see_environment:  # seen from the world's origin
            return np.zeros(3)
        matrix = scene.camera.matrix if texels is None else scene.instances[texels.instance].matrix
        place = np.asarray(matrix, np.float64)[:3, 3]
        if not (np.abs(place) < FARTHEST).all() or not _cell(place).any():
            return np.zeros(3)
        low, high = self._bounds.of(scene)
        return _cell(place if (low > high).any() else np.clip(place, low, high))

    def _centered_instances(self, instances: list[Instance], origin: np.ndarray) -> list[Instance]:
        """Instances counted from the origin: the same objects of those that had been in the scene before."""
        before, made = self._instances
        if same_members(before, instances):
            return made
        is_alike = len(before) == len(instances)
        changed = changed_members(before, instances) if is_alike else np.arange(len(instances))
        rows_before = changed if is_alike else np.arange(len(before))
        known = {id(before[row]): made[row] for row in rows_before.tolist()}
        made = list(made) if is_alike else list(instances)
        new = [row for row in changed.tolist() if id(instances[row]) not in known]
        for row in changed.tolist():
            made[row] = known.get(id(instances[row]), made[row])
        for row, moved in zip(new, _moved([instances[row] for row in new], origin), strict=True):
            made[row] = moved
        self._instances = list(instances), made
        return made


class SceneBounds:
    """Bounds around the instances of scenes that follow each other; only those that are new are looked at."""

    def __init__(self) -> None:
        self._of_positions: dict[int, tuple[np.ndarray, Any]] = {}
        """Bounds of positions by their id, and the positions."""
        self._instances: list[Instance] = []
        self._boxes: list[Any] = []
        """Bounds of the meshes of the scene before, the same objects as long as the positions are; None without any."""
        self._corners = np.zeros((2, 3, 0))
        """(2, 3, instances) low and high, meters; infinite, and the wrong way round, without points. Axes come first:
        NumPy is slow at reducing many short rows."""

    def of(self, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest coordinates of the instances, each (3,) meters; infinite without any."""
        before, self._of_positions = self._of_positions, {}
        for positions in (mesh.positions for mesh in scene.meshes):
            key = id(positions)
            if key not in self._of_positions:
                self._of_positions[key] = before.get(key) or (positions, finite_bounds(positions))
        boxes = [self._of_positions[id(mesh.positions)][1] for mesh in scene.meshes]
        instances, count = scene.instances, len(scene.instances)
        if len(self._instances) == count and same_members(self._boxes, boxes):
            rows = changed_members(self._instances, instances)
        else:
            rows = np.arange(count)
            self._corners = np.array([np.full((3, count), np.inf), np.full((3, count), -np.inf)])
        self._instances = []  # should anything fail
        of_mesh = np.array([np.full((2, 3), np.nan) if box is None else box for box in boxes]).reshape(-1, 2, 3)
        for start in range(0, len(rows), _AT_ONCE):
            part = rows[start : start + _AT_ONCE]
            some = [instances[row] for row in part.tolist()]
            matrices = np.array([instance.matrix for instance in some], np.float64)
            lows, highs, good = placed_boxes(matrices, of_mesh[column(some, "mesh", np.int64)])
            self._corners[0][:, part] = np.where(good, lows.T, np.inf)
            self._corners[1][:, part] = np.where(good, highs.T, -np.inf)
        self._instances, self._boxes = list(instances), boxes
        low, high = self._corners
        return low.min(axis=1, initial=np.inf), high.max(axis=1, initial=-np.inf)


def _moved(instances: list[Instance], origin: np.ndarray) -> list[Instance]:
    """Instances counted from the origin."""
    if not instances:
        return []
    matrices = _shifted(np.array([instance.matrix for instance in instances], np.float64), origin)
    others = map(_OTHERS, instances)
    return [
        Instance(before.mesh, matrix, *rest) for before, matrix, rest in zip(instances, matrices, others, strict=True)
    ]


def _cell(place: np.ndarray) -> np.ndarray:
    return CELL * np.round(place / CELL)


def _shifted(matrices: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Matrices (..., 4, 4) to the world, counted from the origin."""
    result = np.array(matrices, np.float64)
    result[..., :3, 3] -= origin
    return result


def _shifted_camera(camera: Camera, origin: np.ndarray) -> Camera:
    texels = camera.texels
    if texels is not None and texels.viewer is not None:
        *place, is_place = texels.viewer
        x, y, z = np.array(place) - is_place * origin
        texels = dataclasses.replace(texels, viewer=(float(x), float(y), float(z), is_place))
    return dataclasses.replace(camera, matrix=_shifted(camera.matrix, origin), texels=texels)


def _shifted_view(view: DicingView, origin: np.ndarray) -> DicingView:
    return view if view.camera is None else dataclasses.replace(view, camera=_shifted_camera(view.camera, origin))


def _shifted_shutter(shutter: Shutter, scene: Scene, origin: np.ndarray) -> Shutter:
    def shifted(movement: Any) -> Any:
        return dataclasses.replace(movement, matrices=_shifted(movement.matrices, origin))

    def of_light(movement: Movement) -> Movement:
        return movement if scene.lights[movement.member].kind is LightKind.SUN else shifted(movement)

    camera: CameraMovement | None = shutter.camera
    return dataclasses.replace(
        shutter,
        instances=[shifted(movement) for movement in shutter.instances],
        lights=[of_light(movement) for movement in shutter.lights],
        camera=None if camera is None else shifted(camera),
    )
