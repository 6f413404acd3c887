# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing that a scene holds is ignored in silence.

Each property changes what is exported, or a warning, or no picture. A property that comes with a new Blender fails here
until someone decides which of the three it is.
"""

import bpy
import pytest
from changes import changes_of, rna_of, settable, structs_of
from pictures import are_equal, cycles_picture
from rendered import RENDERED
from shader_node_stage import contexts_of, node_changes, node_types, shown_node
from signatures import signature
from stages import STAGES
from without_effect import KINDS_OF_NODES, OTHER_ENGINES, PARTS_OF_NODES, PROPERTIES_OF_NODES, UNREAD, WITHOUT_EFFECT

from rppm_addon.blender.panels.render_tab.cycles_settings import SHARED, SHARED_OF_LAYERS

COPIED = {f"CyclesRenderSettings.{name}" for name in SHARED.values()} | {
    f"CyclesRenderLayerSettings.{name}" for name in SHARED_OF_LAYERS
}
"""Cycles' settings that RPPM has settings of its own for, which Copy from Cycles sets."""
OF_STAGES = {name: set(words.split()) for name, words in RENDERED.items()}
LISTED = {key for words in WITHOUT_EFFECT.values() for key in words.split()}
EVALUATED_TYPES = {"ParticleSettings"}
"""Types of which Blender evaluates nearly all; what engines read is listed as rendered."""
CHOICES_OF_OWN = 1
"""Number of changes of a property that are tried where nothing is expected to happen."""

pytestmark = pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="the lists are those of Blender 5.0")


def stage(scene, folder, name):
    """The scene with a stage in it, and its structs."""
    scene.render.resolution_x = scene.render.resolution_y = 24
    STAGES[name](scene, folder)
    return structs_of(scene)


def test_each_property_is_in_one_list(scene):
    """By the RNA of the types that are listed; no list names what there is not."""
    rendered = set().union(*OF_STAGES.values())
    known = rendered | LISTED | COPIED
    types = {key.partition(".")[0] for key in known} - EVALUATED_TYPES
    there = {key for name in types for key in settable(rna_of(name))}
    assert not sorted(there - known), "nobody has said what these do"
    assert not sorted(key for key in known - there if key.partition(".")[0] in types), "these are not there"
    assert not sorted(rendered & LISTED), "these are rendered, and listed as without effect"
    assert sum(len(words.split()) for words in WITHOUT_EFFECT.values()) == len(LISTED), "some are listed twice"


@pytest.mark.long
@pytest.mark.parametrize("name", STAGES)
def test_properties_change_what_is_exported(scene, tmp_path, name):
    """Each property of a stage's list changes the exported scene, or its warnings."""
    wanted, structs = set(OF_STAGES.get(name, ())), stage(scene, tmp_path, name)
    before = signature()
    for change in (change for struct in structs for change in changes_of(struct)):
        if change.key in wanted:
            with change.made():
                changed = signature() != before
            if changed:
                wanted.discard(change.key)
                before = signature()  # what is given back is not always what it was, to the last bit
    assert not sorted(wanted), "these are ignored in silence"


@pytest.mark.long
@pytest.mark.parametrize("kind", [kind for kind in node_types() if kind not in KINDS_OF_NODES])
def test_properties_of_nodes_change_what_is_exported(scene, kind):
    """Each property and input of a shader node changes what is exported, in the context of one of its choices."""
    node = shown_node(scene, kind)
    if node is None:
        pytest.skip("a base class")
    silent, heard = set(), set()
    for context in (None, *contexts_of(node)):
        if context is not None:
            if not silent:
                break
            try:
                setattr(node, *context)
            except TypeError:  # a choice that is not offered now
                continue
        before = signature()
        for change in node_changes(node):
            if change.key not in heard and not is_listed(change.key):
                with change.made():
                    (heard if signature() != before else silent).add(change.key)
        silent -= heard
    assert not sorted(silent), "these are ignored in silence"


def is_listed(key):
    """Return whether a property of a node is said to be without effect."""
    part, _, name = key.partition(".")[2].rpartition(".")
    return key in PROPERTIES_OF_NODES.split() or name in PARTS_OF_NODES.get(part, "").split()


@pytest.mark.long
@pytest.mark.parametrize("name", ["lamps", "materials"])
def test_what_is_of_others_changes_no_picture_of_cycles(scene, tmp_path, name):
    """Properties that are said to be of other engines, or to be read by none, are without effect in Cycles as well."""
    listed = {*WITHOUT_EFFECT[OTHER_ENGINES].split(), *WITHOUT_EFFECT[UNREAD].split()}
    structs = stage(scene, tmp_path, name)
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.cycles.samples = 1
    before, seen = cycles_picture(tmp_path), []
    for change in (change for struct in structs for change in changes_of(struct)):
        if change.key in listed and seen.count(change.key) < CHOICES_OF_OWN:
            seen.append(change.key)
            if change.key not in {"RenderSettings.use_freestyle", "ViewLayer.use_freestyle"}:  # Blender would draw
                with change.made():
                    assert are_equal(before, cycles_picture(tmp_path)), change.key
    assert len(set(seen)) > 30
