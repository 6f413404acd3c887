# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene at each moment while the shutter is open."""

import dataclasses
from typing import Any

import numpy as np

from .meshes import Mesh
from .motion import Deformation, Movement
from .scene import Scene


class MovingScene:
    """A scene with a shutter, at any time while it is open."""

    def __init__(self, scene: Scene) -> None:
        """scene: one with a shutter."""
        shutter = scene.shutter
        assert shutter is not None
        self._scene, self._shutter = scene, shutter
        self._instances = _Paths(shutter.instances)
        self._lights = _Paths(shutter.lights)
        camera = shutter.camera
        self._camera = None if camera is None else _Paths([Movement(0, camera.times, camera.matrices)])

    def at(self, time: float) -> Scene:
        """The scene at a time from 0 to 1: it shares what does not move, and has no shutter.

        Normals between two shapes are not unit.
        """
        scene, shutter = self._scene, self._shutter
        members: dict[str, Any] = {
            "instances": self._instances.moved(scene.instances, time),
            "lights": self._lights.moved(scene.lights, time),
        }
        if shutter.meshes:
            members["meshes"] = meshes = list(scene.meshes)
            for deformation in shutter.meshes:
                meshes[deformation.mesh] = _deformed(meshes[deformation.mesh], deformation, time)
        if shutter.camera is not None and self._camera is not None:
            (camera,) = self._camera.moved([scene.camera], time)
            first, part = _between(shutter.camera.times, time)
            window = _mixed(shutter.camera.windows, first, part)
            members["camera"] = dataclasses.replace(camera, window=tuple(window.tolist()))
        return dataclasses.replace(scene, shutter=None, **members)


class _Paths:
    """Movements by the members that they move, those with the same times together."""

    def __init__(self, movements: list[Movement]) -> None:
        groups: dict[bytes, list[Movement]] = {}
        for movement in movements:
            groups.setdefault(np.asarray(movement.times, np.float64).tobytes(), []).append(movement)
        self._groups = [
            (
                [movement.member for movement in group],
                group[0].times,
                _Poses(np.stack([movement.matrices for movement in group])),
            )
            for group in groups.values()
        ]

    def moved(self, members: list, time: float) -> list:
        """The members with those that move in their places; the list itself if there are none."""
        if not self._groups:
            return members
        result = list(members)
        for indices, times, poses in self._groups:
            for index, matrix in zip(indices, poses.at(*_between(times, time)), strict=True):
                result[index] = dataclasses.replace(result[index], matrix=matrix)
        return result


class _Poses:
    """(n, keys, 4, 4) matrices as translation, rotation and stretch, each of which changes by itself: what turns goes
    round, as in Cycles (Shoemake and Duff, Matrix Animation and Polar Decomposition, 1992)."""

    def __init__(self, matrices: np.ndarray) -> None:
        self._matrices = np.asarray(matrices, np.float64)
        left, _, right = np.linalg.svd(self._matrices[..., :3, :3])
        rotations = left @ right
        rotations *= np.sign(np.linalg.det(rotations))[..., None, None]  # what is mirrored is so in its stretch
        self._stretches = np.swapaxes(rotations, -1, -2) @ self._matrices[..., :3, :3]
        self._quaternions = _quaternions(rotations)
        for key in range(1, self._quaternions.shape[1]):
            before, after = self._quaternions[:, key - 1], self._quaternions[:, key]
            after[np.einsum("ni,ni->n", before, after) < 0.0] *= -1.0  # the shorter way round

    def at(self, first: int, part: float) -> np.ndarray:
        """(n, 4, 4) matrices, ``part`` of the way from the key ``first`` to the next one."""
        if part in (0.0, 1.0):
            return self._matrices[:, first + int(part)].copy()
        a, b = self._quaternions[:, first], self._quaternions[:, first + 1]
        angle = np.arccos(np.clip(np.einsum("ni,ni->n", a, b), -1.0, 1.0))[:, None]
        near = angle < 1e-6  # the sines would vanish
        sine = np.where(near, 1.0, np.sin(angle))
        weight_a = np.where(near, 1.0 - part, np.sin((1.0 - part) * angle) / sine)
        weight_b = np.where(near, part, np.sin(part * angle) / sine)
        quaternions = weight_a * a + weight_b * b
        quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
        result = np.zeros((len(a), 4, 4))
        result[:, :3, :3] = _rotations(quaternions) @ _mixed(np.swapaxes(self._stretches, 0, 1), first, part)
        result[:, :, 3] = _mixed(np.swapaxes(self._matrices[..., 3], 0, 1), first, part)
        before, after = self._matrices[:, first], self._matrices[:, first + 1]
        resting = (before == after).all(axis=(1, 2))
        result[resting] = before[resting]
        return result


def _between(times: np.ndarray, time: float) -> tuple[int, float]:
    """The key before a time and how far the way to the next one has been gone; keys end it at both ends."""
    first = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
    step = times[first + 1] - times[first]
    return first, float(np.clip((time - times[first]) / step, 0.0, 1.0))


def _mixed(values: np.ndarray, first: int, part: float) -> np.ndarray:
    """Interpolate from the key ``first`` to the next one; values that are equal in both come out unchanged."""
    return values[first] + values.dtype.type(part) * (values[first + 1] - values[first])


def _deformed(mesh: Mesh, deformation: Deformation, time: float) -> Mesh:
    first, part = _between(deformation.times, time)
    return dataclasses.replace(
        mesh,
        positions=_mixed(deformation.positions, first, part),
        corner_normals=_mixed(deformation.corner_normals, first, part),
    )


def _quaternions(rotations: np.ndarray) -> np.ndarray:
    """(..., 4) unit quaternions w, x, y, z of rotations (..., 3, 3)."""
    r = rotations
    # Of the four ways to find it the one that divides by the largest component.
    diagonal = np.stack([r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]], axis=-1)
    trace = diagonal.sum(axis=-1, keepdims=True)
    squares = np.concatenate([1.0 + trace, 1.0 - trace + 2.0 * diagonal], axis=-1)  # four times each component's
    products = np.empty((*r.shape[:-2], 4, 4))
    for i in range(4):
        products[..., i, i] = squares[..., i]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        products[..., 0, i + 1] = products[..., i + 1, 0] = r[..., k, j] - r[..., j, k]
        products[..., j + 1, k + 1] = products[..., k + 1, j + 1] = r[..., k, j] + r[..., j, k]
    largest = np.argmax(squares, axis=-1)
    found = np.take_along_axis(products, largest[..., None, None], axis=-2)[..., 0, :]
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


def _rotations(quaternions: np.ndarray) -> np.ndarray:
    """(n, 3, 3) rotations of unit quaternions (n, 4)."""
    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
