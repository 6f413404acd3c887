# SPDX-License-Identifier: GPL-3.0-or-later
"""The gate for what comes from elsewhere: files, other processes, Blender. It holds dataclasses to their declarations.

Types come from the annotations of fields, shapes, ranges and references from what ``declared`` says of them. Records of
a list are checked field by field, so that thousands of instances cost little more than one.
"""

import dataclasses
import enum
import functools
import operator
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..camera import Camera, Texels
from ..common.declared import FLOAT_MAX, Declared, declared_of
from ..errors import SceneError
from ..meshes import SMOOTH_NORMALS, AttributeDomain, InstanceArray, Mesh
from ..motion import CameraMovement, Deformation, Movement, Shutter
from ..node_graphs import Link, NodeGraph
from ..scene import Scene
from ..volumes import VolumeMotion

_Label = Callable[[int], str]
"""Function that returns the name in messages of the member at an index."""
_LISTS = ("meshes", "instances", "lights", "materials", "images")
_LARGEST_INTEGER = (1 << 63) - 1
_MIN_STRETCH = 1e-9
"""Volume of a camera's axes over the product of their lengths: less is no camera that looks anywhere."""


def check_scene(scene: Scene) -> None:
    """Raise SceneError, naming member and field, unless the scene is what its declaration says."""
    lengths = {name: len(getattr(scene, name)) for name in _LISTS if isinstance(getattr(scene, name), list)}
    if isinstance(scene.instance_arrays, list) and "instances" in lengths:
        arrays = [array for array in scene.instance_arrays if isinstance(array, InstanceArray)]
        lengths["instances"] += sum(len(array.places) for array in arrays if isinstance(array.places, np.ndarray))
    _Gate(lengths).records(Scene, [scene], lambda _: "")
    scene = scene.expanded()
    if scene.camera.texels is not None:
        _check_texels(scene, scene.camera.texels)
    for name, shutter in {"shutter": scene.shutter, "neighbors": scene.neighbors}.items():
        if shutter is not None:
            _check_members(scene, shutter, name)


def check_record(record: object, kind: type, finite: bool = False) -> None:
    """Raise SceneError unless a record is a ``kind`` and what its declaration says. References are not followed, and
    numbers may be any unless they must be finite."""
    if type(record) is not kind:
        raise SceneError(f"{_shown(record)} is no {kind.__name__}")
    _Gate({}, finite).records(kind, [record], lambda _: "")


class _Gate:
    """Checks records; what their indices count is known."""

    def __init__(self, lengths: Mapping[str, int], finite: bool = True) -> None:
        self._lengths = lengths
        self._finite = finite

    def records(self, kind: type, records: Sequence[Any], label: _Label) -> None:
        """Check all fields of many records of one dataclass."""
        hints, fields = _hints(kind), dataclasses.fields(kind)
        # What arrays of one record have in common; records without any share one, which stays empty.
        own: Sequence[dict[str, int]] = [{} for _ in records] if _has_lengths(kind) else [{}] * len(records)
        for field in fields:
            values = list(map(operator.attrgetter(field.name), records))
            self._values(hints[field.name], declared_of(field), values, own, _below(label, field.name))
        extra = _EXTRA.get(kind)
        if extra is not None:
            for place, record in enumerate(records):
                extra(record, label(place))

    def _values(self, hint: Any, said: Declared, values: list, own: Sequence[dict[str, int]], label: _Label) -> None:
        """Check the values that records have of one field."""
        origin, inner = typing.get_origin(hint), typing.get_args(hint)
        if origin in {typing.Union, types.UnionType}:
            there = [place for place, value in enumerate(values) if value is not None]
            some = [values[place] for place in there]
            self._values(inner[0], said, some, [own[place] for place in there], lambda place: label(there[place]))
        elif origin in {list, tuple}:
            self._sequences(origin, inner, said, values, own, label)
        elif origin is dict:
            self._dictionaries(inner[1], said, values, label)
        elif hint is np.ndarray:
            self._arrays(said, values, own, label)
        elif hint is Any:
            pass
        elif hint is object:
            for place, value in enumerate(values):
                _check_node_value(value, place, label)
        elif hint in {int, float}:
            self._numbers(hint, said, values, label)
        else:
            _demand_type(values, hint, label)
            if dataclasses.is_dataclass(hint):
                self.records(typing.cast(type, hint), values, label)
            elif issubclass(hint, enum.Flag):
                every = functools.reduce(operator.or_, hint).value
                _demand([0 <= value.value <= every for value in values], values, label, f"0 to {every}")
            elif said.choices:
                _demand([value in said.choices for value in values], values, label, _one_of(said.choices))

    def _dictionaries(self, inner: Any, said: Declared, values: list, label: _Label) -> None:
        _demand_type(values, dict, label)
        _demand_type([key for value in values for key in value], str, _flat(values, label))
        items = [item for value in values for item in value.values()]
        names = [(place, key) for place, value in enumerate(values) for key in value]

        def called(place: int) -> str:
            owner, key = names[place]
            return f'{label(owner)}["{_escaped(key)}"]'

        self._values(inner, said, items, [{}] * len(items), called)

    def _sequences(
        self, origin: type, inner: tuple, said: Declared, values: list, own: Sequence[dict[str, int]], label: _Label
    ) -> None:
        _demand_type(values, origin, label)
        if origin is tuple and inner[-1] is not Ellipsis:
            _demand([len(value) == len(inner) for value in values], values, label, f"{len(inner)} values")
        items = [item for value in values for item in value]
        self._values(inner[0] if inner else object, said, items, [{}] * len(items), _flat(values, label))

    def _numbers(self, hint: type, said: Declared, values: list, label: _Label) -> None:
        kinds = (int, np.integer) if hint is int else (int, float, np.integer, np.floating)
        for other in set(map(type, values)):
            if other is bool or not issubclass(other, kinds):
                _demand([type(value) is not other for value in values], values, label, f"a {hint.__name__}")
        low, high = said.minimum, said.maximum
        if said.below:
            low = 0 if low is None else low
            high = self._lengths[said.below] - 1 if said.below in self._lengths else None
        if hint is int:
            low, high = -_LARGEST_INTEGER if low is None else low, _LARGEST_INTEGER if high is None else high
            _demand([low <= value <= high for value in values], values, label, _range(low, high, said))
        else:
            self._in_range(np.array(values, np.float64), said, values, label)

    def _in_range(self, numbers: np.ndarray, said: Declared, values: Sequence, label: _Label) -> None:
        good = np.abs(numbers) <= FLOAT_MAX if said.finite and self._finite else np.ones(len(numbers), bool)
        if said.minimum is not None:
            good &= ~(numbers < said.minimum)
        if said.maximum is not None:
            good &= ~(numbers > said.maximum)
        if not good.all():
            _demand(good, values, label, _range(said.minimum, said.maximum, said))

    def _arrays(self, said: Declared, values: list, own: Sequence[dict[str, int]], label: _Label) -> None:
        _demand_type(values, np.ndarray, label)
        if _are_alike(said, values):  # thousands of matrices
            values = values[:1]
        for place, value in enumerate(values):
            self._array(said, value, own[place], functools.partial(label, place))

    def _array(self, said: Declared, value: np.ndarray, own: dict[str, int], label: Callable[[], str]) -> None:
        is_kind = value.dtype.kind in said.types if len(said.types) < _NAME_LENGTH else value.dtype.name == said.types
        if not is_kind:
            raise SceneError(f"{label()} is an array of {value.dtype}, which it must not be")
        if said.shape is not None:
            expected = [own.get(length) if isinstance(length, str) else length for length in said.shape]
            if value.ndim != len(expected) or any(
                length not in (None, found) for length, found in zip(expected, value.shape, strict=True)
            ):
                known = ", ".join(f"{count} {name}" for name, count in own.items())
                shape = ", ".join(map(str, said.shape))
                owner = f", of {known}" if known else ""
                raise SceneError(f"{label()} has the shape {value.shape}; it must be ({shape}){owner}")
            own.update({name: found for name, found in zip(said.shape, value.shape) if isinstance(name, str)})
        if value.size == 0:
            return
        if said.below:
            _check_indices(said, value, own.get(said.below, self._lengths.get(said.below)), label)
        elif said.finite or said.minimum is not None or said.maximum is not None:
            low, high = float(value.min()), float(value.max())  # not a number where any is none
            self._in_range(np.array([low, high]), said, [low, high], lambda _: label())


def _check_indices(said: Declared, value: np.ndarray, count: int | None, label: Callable[[], str]) -> None:
    low = 0 if said.minimum is None else int(said.minimum)
    least, greatest = int(value.min()), int(value.max())
    if least < low or (count is not None and greatest >= count):
        wrong = least if least < low else greatest
        raise SceneError(f"{label()} has the index {wrong}; there are {count} {said.below}")


def _check_node_value(value: object, place: int, label: _Label) -> None:
    """An input or option of a shader node."""
    if isinstance(value, str | bool | Link):
        return
    numbers = value.tolist() if isinstance(value, np.ndarray) else value if isinstance(value, tuple | list) else [value]
    kinds = (int, float, np.integer, np.floating)
    if not isinstance(numbers, list | tuple) or not all(isinstance(number, kinds) for number in numbers):
        raise SceneError(f"{label(place)} is {_shown(value)}; it must be a number, a color, a text or a link")
    if len(numbers) > _MAX_CHANNELS or not all(abs(number) <= FLOAT_MAX for number in numbers):
        raise SceneError(f"{label(place)} is {_shown(value)}; it must be finite, {_MAX_CHANNELS} numbers at most")


_NAME_LENGTH = 4
"""Longer ones are names of dtypes, shorter ones kinds."""
_MAX_CHANNELS = 4


@functools.cache
def _hints(kind: type) -> dict[str, Any]:
    return typing.get_type_hints(kind)


@functools.cache
def _has_lengths(kind: type) -> bool:
    shapes = (declared_of(field).shape or () for field in dataclasses.fields(kind))
    return any(isinstance(length, str) for shape in shapes for length in shape)


def _are_alike(said: Declared, values: Sequence) -> bool:
    """Whether one of many arrays is enough to know of all."""
    if said.finite or said.below or any(isinstance(length, str) for length in said.shape or ()):
        return False
    return all(isinstance(value, np.ndarray) for value in values) and (
        len({(value.shape, value.dtype) for value in values}) == 1
    )


def _below(label: _Label, name: str) -> _Label:
    """Names of a field of what is called ``label``."""

    def called(place: int) -> str:
        return f"{above}: {name}" if (above := label(place)) else name

    return called


def _flat(values: Sequence[Sequence], label: _Label) -> _Label:
    """Names of the items of many sequences, laid end to end."""

    def called(place: int) -> str:
        for number, value in enumerate(values):
            if place < len(value):
                items = list(value)
                name = getattr(items[place], "name", "") or getattr(items[place], "object_name", "")
                return f"{label(number)}[{place}]" + (f' "{_escaped(name)}"' if isinstance(name, str) and name else "")
            place -= len(value)
        return label(len(values) - 1)

    return called


def _escaped(text: str) -> str:
    """A name without what terminals obey."""
    return text if text.isprintable() else repr(text)[1:-1]


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]}..."


_LONGEST_SHOWN = 60


def _demand(good: Sequence | np.ndarray, values: Sequence, label: _Label, what: str) -> None:
    """Raise SceneError for the first value that is not good."""
    for place, is_good in enumerate(good):
        if not is_good:
            raise SceneError(f"{label(place)} is {_shown(values[place])}; it must be {what}")


def _demand_type(values: Sequence, kind: type, label: _Label) -> None:
    if any(other is not kind and not issubclass(other, kind) for other in set(map(type, values))):
        _demand([isinstance(value, kind) for value in values], values, label, f"a {kind.__name__}")


def _range(low: float | None, high: float | None, said: Declared) -> str:
    if said.below:
        return f"the index of one of {0 if high is None else int(high) + 1} {said.below}"
    if low is not None and high is not None and abs(high) < _LARGEST_INTEGER:
        return f"{low:g} to {high:g}"
    if low is not None and low > -_LARGEST_INTEGER:
        return f"{low:g} or more, and finite"
    return "finite"


def _one_of(choices: Sequence[str]) -> str:
    return f"one of {', '.join(choices)}"


# What no declaration of a single field can say.


def _check_mesh(mesh: Mesh, label: str) -> None:
    counts = {
        AttributeDomain.POINT: len(mesh.positions),
        AttributeDomain.CORNER: len(mesh.corner_vertices),
        AttributeDomain.TRIANGLE: len(mesh.triangle_corners),
    }
    for name, attribute in mesh.attributes.items():
        shape, count = attribute.values.shape, counts[attribute.domain]
        if len(shape) != 2 or shape[0] != count or not 1 <= shape[1] <= _MAX_CHANNELS:
            domain = attribute.domain.value
            raise SceneError(
                f'{label}: attributes["{_escaped(name)}"] has the shape {shape}; there are {count} {domain}s'
            )
        if name == SMOOTH_NORMALS and (attribute.domain is not AttributeDomain.CORNER or shape[1] != _MAX_CHANNELS):
            raise SceneError(f'{label}: attributes["{name}"] must have {_MAX_CHANNELS} numbers for each corner')


def _check_instance_array(array: InstanceArray, label: str) -> None:
    count = len(array)
    if count == 0 or (np.diff(array.places) <= 0).any():
        raise SceneError(f"{label}: places must ascend, and there must be one")
    if array.particles is not None and len(array.particles) != count:
        raise SceneError(f"{label}: there are {len(array.particles)} particles; there must be {count}")
    for name, values in array.attributes.items():
        if values.ndim != 2 or len(values) != count or not 1 <= values.shape[1] <= _MAX_CHANNELS:
            raise SceneError(
                f'{label}: attributes["{_escaped(name)}"] has the shape {values.shape}; there are {count} instances'
            )


def _check_graph(graph: NodeGraph, label: str) -> None:
    for place, node in enumerate(graph.nodes):
        _check_links(node.inputs.values(), place, f'{label}: nodes[{place}] "{_escaped(node.name or node.kind)}"')
    ends = [
        graph.surface,
        graph.normal,
        graph.displacement,
        *(value for aov in graph.aovs for value in (aov.color, aov.value)),
    ]
    _check_links(ends, len(graph.nodes), label)


def _check_links(values: typing.Iterable[object], count: int, label: str) -> None:
    """Links lead to one of the first ``count`` nodes."""
    for value in values:
        if isinstance(value, Link):
            if type(value.node) is not int or not isinstance(value.output, str):
                raise SceneError(f"{label} has the link {_shown(value)}, which is none")
            if not 0 <= value.node < count:
                raise SceneError(f"{label} links to node {value.node}; there are {count} that it may link to")


def _check_camera(camera: Camera, label: str) -> None:
    axes = camera.matrix[:3, :3].astype(np.float64)
    lengths = np.linalg.norm(axes, axis=0)
    if not lengths.all() or abs(np.linalg.det(axes / lengths)) < _MIN_STRETCH:
        raise SceneError(f"{label}: matrix has axes of no length or in one plane; give the camera a rotation and scale")
    left, right, bottom, top = camera.window
    if not (left < right and bottom < top):
        raise SceneError(f"{label}: window is {camera.window}; left must be less than right, bottom less than top")
    if camera.crop is not None:
        x_min, y_min, x_max, y_max = camera.crop
        if not (0 <= x_min < x_max <= camera.width and 0 <= y_min < y_max <= camera.height):
            raise SceneError(f"{label}: crop is {camera.crop}; it must lie in {camera.width} x {camera.height} pixels")


def _check_times(moved: Movement | Deformation | CameraMovement, label: str) -> None:
    times = moved.times
    if len(times) == 0 or times[0] < 0.0 or times[-1] > 1.0 or (np.diff(times) <= 0.0).any():
        raise SceneError(f"{label}: times must ascend from 0 to 1")


def _check_shutter(shutter: Shutter, label: str) -> None:
    if len(shutter.curve) == 0:
        raise SceneError(f"{label}: curve is empty; it must have a value")


def _check_volume_motion(motion: VolumeMotion, label: str) -> None:
    values = motion.displacements.values
    if values.shape[3] != 3 or not values.size or not np.isfinite(values).all():
        raise SceneError(f"{label}: displacements must have voxels of three finite numbers each")


def _check_texels(scene: Scene, texels: Texels) -> None:
    """A texture that is baked lies on the triangles of its mesh."""
    width, height = scene.camera.resolution
    if texels.triangles.shape != (height, width):
        raise SceneError(f"camera: texels: triangles has the shape {texels.triangles.shape}, not ({height}, {width})")
    count = scene.meshes[scene.instances[texels.instance].mesh].triangle_count
    greatest = int(texels.triangles.max())
    if 0 < count <= greatest:  # of meshes without any the renderer reports more
        raise SceneError(f"camera: texels: triangles has the index {greatest}; there are {count} triangles")


def _check_members(scene: Scene, shutter: Shutter, label: str) -> None:
    """Raise SceneError where a member that moves does not exist, or a deformation does not fit its mesh."""
    for kind, moved, count in (
        ("instances", shutter.instances, len(scene.instances)),
        ("lights", shutter.lights, len(scene.lights)),
    ):
        for place, movement in enumerate(moved):
            if not 0 <= movement.member < count:
                raise SceneError(f"{label}: {kind}[{place}]: member is {movement.member}; there are {count} {kind}")
    for place, bent in enumerate(shutter.meshes):
        _check_deformation(bent, scene.meshes[bent.mesh], f"{label}: meshes[{place}]")


def _check_deformation(bent: Deformation, mesh: Mesh, label: str) -> None:
    found = bent.positions.shape[1], bent.corner_normals.shape[1]
    if found != (len(mesh.positions), len(mesh.corner_vertices)):
        name = _escaped(mesh.name)
        raise SceneError(f'{label} has {found[0]} vertices and {found[1]} corners, unlike the mesh "{name}"')


_EXTRA: dict[type, Callable[[Any, str], None]] = {
    Mesh: _check_mesh,
    InstanceArray: _check_instance_array,
    NodeGraph: _check_graph,
    Camera: _check_camera,
    Movement: _check_times,
    Deformation: _check_times,
    CameraMovement: _check_times,
    Shutter: _check_shutter,
    VolumeMotion: _check_volume_motion,
}
