# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of storage buffers, each declared once: by name, record and count.

A subclass of BufferSet declares them as members of its class::

    class Importons(BufferSet):
        remedy = "lower the resolution"
        rays = StorageBuffer("camera rays", RAY, band_pixels, block="Rays")

and from that follow their allocation, what they take (``memory_bytes``), what they will take (``expected_bytes``), the
storage blocks that they are bound as (``blocks``), and their release. ``self.rays`` is a GrowingBuffer. Programs are
declared in the same way (``ComputeShader``). A set that is not needed for its sizes (``is_needed``) has neither.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, ClassVar, Generic, Protocol, TypeVar, overload

import moderngl

from ..scene.errors import DeviceError
from .buffers.buffers import REMEDY, SMALLEST, GrowingBuffer, refuse_large_block
from .buffers.records import Record, stride
from .context.context import Context
from .programs.program import Bindable, ComputeProgram
from .programs.programs import ProgramLibrary

Count = Callable[[Any], int]
"""Items by the sizes that a set was made for."""


class Resource(Protocol):
    """An object on the device that can be released."""

    def release(self) -> object:
        """Free it on the device."""


Owned = TypeVar("Owned", bound=Resource)
Made = TypeVar("Made", bound=Resource)
Set = TypeVar("Set", bound="BufferSet")


class Declared(Generic[Made]):
    """A member of a set's class for which each set has one of its own, made with the set."""

    @overload
    def __get__(self, instance: None, owner: type) -> "Declared[Made]": ...

    @overload
    def __get__(self, instance: "BufferSet", owner: type) -> Made: ...

    def __get__(self, instance: "BufferSet | None", owner: type) -> "Declared[Made] | Made":
        # What a set has made stands among its own attributes, which Python looks up first.
        if instance is None:
            return self
        raise AttributeError(
            f"{owner.__name__} has no buffers or programs: it is off (is_needed), or BufferSet.__init__ comes later"
        )

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> Made:
        """The set's own one, for these sizes. Raises DeviceError when the device has no room for it."""
        raise NotImplementedError

    def make_empty(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> Made | None:
        """Return the member of a set that is off, without items; None where such a set has none."""
        return self.make(context, library, sizes, remedy)

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """By name, the bytes that follow from the sizes."""
        raise NotImplementedError

    def refuse_large(self, context: Context, sizes: object, remedy: str) -> None:
        """Raise DeviceError, before anything is made, where a buffer would be larger than the device allows one to
        be."""
        for name, size in self.expected_bytes(sizes).items():
            refuse_large_block(context, name, size, remedy)


class StorageBuffer(Declared[GrowingBuffer]):
    """A buffer of ``count`` items behind a header: ``item`` and ``header`` are records, or kinds such as "vec4".

    Without a count its length follows from the scene, and whoever fills it requires it; where the count is 0 there is
    none. remedy: the set's if none is given. texel_bytes: that of GrowingBuffer. block: name of the storage block that
    shaders read or write it as. zeroed: whether its items are 0 at first.
    """

    def __init__(
        self,
        name: str,
        item: Record | str,
        count: Count | int | None = None,
        header: Record | str | None = None,
        remedy: str | None = None,
        texel_bytes: int | None = None,
        block: str = "",
        zeroed: bool = False,
    ) -> None:
        self.block = block
        self._zeroed = zeroed
        self._name, self._remedy, self._count = name, remedy, count
        self._texel_bytes = texel_bytes
        self._item_size, self._header_size = stride(item), stride(header) if header else 0

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> GrowingBuffer:
        """Declared.make."""
        buffer = self.make_empty(context, library, sizes, remedy)
        if count := self._count_for(sizes):
            buffer.require_items(count)
            if self._zeroed:
                buffer.clear()
        return buffer

    def make_empty(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> GrowingBuffer:
        """Declared.make_empty."""
        item_sizes = self._item_size, self._header_size
        return GrowingBuffer(context, self._name, self._remedy or remedy, *item_sizes, self._texel_bytes)

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """Declared.expected_bytes."""
        count = self._count_for(sizes)
        return {self._name: max(self._header_size + self._item_size * count, SMALLEST)} if count else {}

    def refuse_large(self, context: Context, sizes: object, remedy: str) -> None:
        """Declared.refuse_large."""
        for name, size in self.expected_bytes(sizes).items():
            refuse_large_block(context, name, size, self._remedy or remedy, context.array_limit(self._texel_bytes))

    def _count_for(self, sizes: object) -> int:
        return self._count(sizes) if callable(self._count) else self._count or 0


class BufferList(list[GrowingBuffer]):
    """Buffers of one name, which are given back together."""

    def release(self) -> None:
        """Free them."""
        for buffer in self:
            buffer.release()


class Part(Declared[Set]):
    """A set within a set, made for the same sizes."""

    def __init__(self, kind: type[Set]) -> None:
        self.kind = kind

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> Set:
        """Declared.make."""
        return self.kind(context, library, sizes)

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """Declared.expected_bytes."""
        return self.kind.expected_bytes(sizes)

    def refuse_large(self, context: Context, sizes: object, remedy: str) -> None:
        """Declared.refuse_large."""
        self.kind.refuse_large(context, sizes)


class ComputeShader(Declared[ComputeProgram]):
    """A compute program, by the path of its shader. It belongs to the library, and a set that is off has none."""

    def __init__(self, path: str) -> None:
        self._path = path

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> ComputeProgram:
        """Return the program. Raises ShaderError as ProgramLibrary.compute does."""
        return library.compute(self._path)

    def make_empty(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> None:
        """Declared.make_empty."""

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """Declared.expected_bytes: none."""
        return {}


class BufferSet:
    """Owner of what it declares and of what else is given to it."""

    remedy: ClassVar[str] = REMEDY
    """Advice to the user where the device has no room for a buffer."""
    _declared: ClassVar[dict[str, Declared]] = {}
    """Declared members by attribute: those of the base classes, then those of the class."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        members = (item for base in reversed(cls.__mro__) for item in vars(base).items())
        cls._declared = {name: member for name, member in members if isinstance(member, Declared)}

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        """sizes: what the counts follow from. Raises DeviceError when the device has no room."""
        self.is_on = self.is_needed(sizes)
        """Whether the set has its buffers and programs."""
        self._owned: list[tuple[Resource, str]] = []
        self._sets: list[BufferSet] = []
        self._block_buffers: list[tuple[str, GrowingBuffer]] = []
        """Buffers that are bound as storage blocks, each with the block's name."""
        for name, declared in self._declared.items():
            make = declared.make if self.is_on else declared.make_empty
            made = make(context, library, sizes, self.remedy)
            if made is None:
                continue
            vars(self)[name] = made
            if not isinstance(declared, ComputeShader):
                self.own(made)
            if isinstance(made, BufferSet):
                self._sets.append(made)
            elif isinstance(declared, StorageBuffer) and declared.block:
                self._block_buffers.append((declared.block, made))

    def own(self, resource: Owned, name: str = "") -> Owned:
        """Release it with the set; returns it. name: by which a texture is reported."""
        self._owned.append((resource, name))
        return resource

    def disown(self, resource: Resource) -> None:
        """Release it now."""
        self._owned = [entry for entry in self._owned if entry[0] is not resource]
        resource.release()

    @property
    def blocks(self) -> dict[str, Bindable]:
        """Buffers by the names of the storage blocks that they are bound as, those of its parts among them.

        A block that several parts have is left out: who binds it names the part.
        """
        own: dict[str, Bindable] = {block: buffer.buffer for block, buffer in self._block_buffers}
        if not self._sets:
            return own
        of_parts: dict[str, Bindable] = {}
        ambiguous: set[str] = set()
        for part in self._sets:
            found = part.blocks
            ambiguous |= of_parts.keys() & found.keys()
            of_parts |= found
        return {block: buffer for block, buffer in of_parts.items() if block not in ambiguous} | own

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer; those without any are left out."""
        return sum_by_name(_bytes_of(resource, name) for resource, name in self._owned)

    @classmethod
    def is_needed(cls, sizes: Any) -> bool:  # noqa: ARG003  sets that are not always needed ask them
        """Whether a set for these sizes is used at all. Without, its buffers are empty and it has no programs."""
        return True

    @classmethod
    def part_kinds(cls) -> list[type["BufferSet"]]:
        """The classes of its parts."""
        return [declared.kind for declared in cls._declared.values() if isinstance(declared, Part)]

    @classmethod
    def expected_bytes(cls, sizes: object) -> dict[str, int]:
        """By name, the bytes that follow from the sizes, known before anything is allocated."""
        if not cls.is_needed(sizes):
            return {}
        return sum_by_name(declared.expected_bytes(sizes) for declared in cls._declared.values())

    @classmethod
    def refuse_large(cls, context: Context, sizes: object) -> None:
        """Raise DeviceError, before anything is made, where a buffer would be larger than the device allows one to be,
        or all together than what it has left."""
        if not cls.is_needed(sizes):
            return
        for declared in cls._declared.values():
            declared.refuse_large(context, sizes, cls.remedy)
        needed, available = sum(cls.expected_bytes(sizes).values()), context.available_memory
        if available is not None and needed > available:
            raise DeviceError(
                f"{needed / 2**20:.0f} MiB are needed but the device {context.information.name} has "
                f"{available / 2**20:.0f} MiB left; {cls.remedy}"
            )

    def release(self) -> None:
        """Free all of it on the device."""
        for resource, _ in self._owned:
            resource.release()
        self._owned = []


def sum_by_name(parts: Iterable[Mapping[str, int]]) -> dict[str, int]:
    """Sum the values of the parts under each name."""
    sums: dict[str, int] = {}
    for part in parts:
        for name, size in part.items():
            sums[name] = sums.get(name, 0) + size
    return sums


def _bytes_of(resource: Resource, name: str = "") -> dict[str, int]:
    if isinstance(resource, BufferSet):
        return resource.memory_bytes
    if isinstance(resource, BufferList):
        return sum_by_name(map(_bytes_of, resource))
    if isinstance(resource, GrowingBuffer):
        return {resource.name: resource.size} if resource.size else {}
    if isinstance(resource, moderngl.Texture):
        # dtype ends with the bytes of a component.
        return {name: resource.width * resource.height * resource.components * int(resource.dtype[-1])}
    return {}
