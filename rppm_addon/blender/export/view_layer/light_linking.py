# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's light and shadow linking to sets of objects, whose changes Blender does not report.

Numbered as Blender does: a collection that emitters name is known by its bit, an object by which collections include
it and which exclude it, and objects that agree in these are a set.
"""

from collections.abc import Iterable, Iterator

import bpy

from ....scene import ALL_SETS, LIGHT_SETS, LightLinking
from ..common.report import Report

_Masks = tuple[int, int]
"""Bits of the collections that include an object, and of those that exclude it."""


class LightLinks:
    """The linking of the objects of a view layer."""

    def __init__(self, layer: bpy.types.ViewLayer | None = None) -> None:
        emitters = [] if layer is None else list(_emitters(layer.objects))
        lit, lit_by = _Linking(), {}
        shadows, shadowed_by = _Linking(), {}
        for emitter in emitters:
            linking, uid = emitter.light_linking, emitter.session_uid
            if linking.receiver_collection is not None:
                lit_by[uid] = lit.add(linking.receiver_collection)
            if linking.blocker_collection is not None:
                shadowed_by[uid] = shadows.add(linking.blocker_collection)
        lit.number()
        shadows.number()
        self.are_too_many = lit.are_too_many or shadows.are_too_many
        self._by_uid = {
            uid: LightLinking(
                lit.sets.get(uid, 0),
                shadows.sets.get(uid, 0),
                lit.membership(lit_by.get(uid)),
                shadows.membership(shadowed_by.get(uid)),
            )
            for uid in {*lit.sets, *shadows.sets, *lit_by, *shadowed_by}
        }

    @property
    def state(self) -> dict[int, LightLinking]:
        """Linking by session_uid; it is equal where the linking is as it was."""
        return self._by_uid

    def of(self, owner: bpy.types.Object) -> LightLinking | None:
        """Return the linking of what an object brings, itself or its instances; None where it is not linked."""
        return self._by_uid.get(owner.original.session_uid) if self._by_uid else None

    def warn(self, report: Report) -> None:
        """Warn where there are more collections or sets than lights can distinguish."""
        if self.are_too_many:
            report.warn(
                f"Light Linking: more than {LIGHT_SETS - 1} sets of objects are linked, and those beyond count as not "
                "linked; use fewer collections"
            )


def _emitters(objects: Iterable[bpy.types.Object]) -> Iterator[bpy.types.Object]:
    for candidate in objects:
        linking = candidate.light_linking
        if linking.receiver_collection is not None or linking.blocker_collection is not None:
            yield candidate


class _Linking:
    """Light linking or shadow linking."""

    def __init__(self) -> None:
        self._bits: dict[int, int] = {}
        """Bits of the emitters' collections, by session_uid."""
        self._masks: dict[int, _Masks] = {}
        """Bits for the objects in the emitters' collections, by session_uid."""
        self._memberships: dict[int, int] = {}
        self.sets: dict[int, int] = {}
        """Numbers of sets by the session_uid of the objects in them."""
        self.are_too_many = False

    def add(self, collection: bpy.types.Collection) -> int:
        """Take an emitter's collection; returns its bit, 0 where there are too many."""
        uid = collection.session_uid
        if uid not in self._bits:
            self._bits[uid] = 1 << len(self._bits) if len(self._bits) < LIGHT_SETS else 0
            self.are_too_many |= self._bits[uid] == 0
            for linked, includes in _linked_objects(collection):
                self._link(linked.session_uid, self._bits[uid], includes)
        return self._bits[uid]

    def _link(self, uid: int, bit: int, includes: bool) -> None:
        included, excluded = self._masks.get(uid, (0, 0))
        self._masks[uid] = (included | bit, excluded & ~bit) if includes else (included & ~bit, excluded | bit)

    def number(self) -> None:
        """Give the objects their sets, and the collections what these make of them."""
        numbers: dict[_Masks, int] = {}
        for uid, masks in self._masks.items():
            number = numbers.setdefault(masks, len(numbers) + 1)
            if number < LIGHT_SETS:
                self.sets[uid] = number
        self.are_too_many |= len(numbers) >= LIGHT_SETS
        for bit in filter(None, self._bits.values()):
            included, excluded = (
                sum(1 << number for masks, number in numbers.items() if masks[k] & bit and number < LIGHT_SETS)
                for k in range(2)
            )
            # Where nothing is included all is, but for what is excluded.
            self._memberships[bit] = (included or ALL_SETS) & ~excluded

    def membership(self, bit: int | None) -> int:
        """Bits of the sets of an emitter with this collection's bit, as a signed number of 64."""
        membership = self._memberships.get(bit or 0, ALL_SETS)
        return membership - (1 << 64) if membership >= 1 << 63 else membership


def _linked_objects(collection: bpy.types.Collection) -> Iterator[tuple[bpy.types.Object, bool]]:
    """Objects and whether the emitter is linked with them, in Blender's order, in which the last word counts: of the
    first level's collections all that is in them, then single objects."""
    for child, said in zip(collection.children, collection.collection_children, strict=True):
        for linked in _within(child):
            yield linked, said.light_linking.link_state == "INCLUDE"
    for linked, said in zip(collection.objects, collection.collection_objects, strict=True):
        yield linked, said.light_linking.link_state == "INCLUDE"


def _within(collection: bpy.types.Collection) -> Iterator[bpy.types.Object]:
    for child in collection.children:
        yield from _within(child)
    yield from collection.objects
