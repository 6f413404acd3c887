# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs for hair, light below surfaces, displacement or rays of nodes are compiled ahead like all others."""

import dataclasses
from types import SimpleNamespace

import pytest
from session.conftest import run_to_the_end
from support.floor import floor_scene
from support.graphs import surface_graph

from rppm_addon.gl.programs import program_maker
from rppm_addon.gl.programs.binary_cache import BinaryCache
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.gl.programs.sources import CompileError
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.stage_set import StageSet
from rppm_addon.integrator.viewport.pictures import demands_of
from rppm_addon.scene import Material, NodeGraph
from rppm_addon.scene.common.working_space import ACESCG, REC709
from rppm_addon.session.placeholders.known_programs import KnownPrograms, programs_of
from rppm_addon.session.placeholders.stand_ins import StandIns
from rppm_addon.session.worker.preparation import Preparation


class Collected:
    """In a background compiler's place: notes what is submitted, and compiles nothing."""

    def __init__(self):
        self.texts = set()

    def submit(self, source, needed=True):
        self.texts.add(source.text)

    def knows(self, source):
        return source.text in self.texts

    def has_tried(self, source):
        return False

    def hurry(self, hurries):
        pass

    def stop(self):
        pass

    def release(self):
        pass


def simple(kind):
    return Material(kind, surface_graph(kind))


def on_strands():
    return dataclasses.replace(simple("bsdf_hair_principled"), on_round_shapes=True)


def wax():
    return simple("subsurface_scattering")


def displaced():
    material = simple("bsdf_diffuse")
    material.graph.displacement = material.graph.add("displacement", "displacement", height=1.0)
    return material


def occluded():
    graph = NodeGraph()
    color = graph.add("ambient_occlusion", "color")
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=color)
    return Material("occluded", graph)


def phong():
    material = simple("bsdf_glossy")
    material.graph.nodes[0].options["distribution"] = "ASHIKHMIN_SHIRLEY"
    return material


FEATURES = (on_strands, wax, displaced, occluded, phong)


def with_material(feature):
    scene = floor_scene()
    return dataclasses.replace(scene, materials=[*scene.materials, feature()])


@pytest.fixture
def submitted(monkeypatch):
    """Texts of the programs that libraries have compiled in the background; none comes from the disk."""
    collected = Collected()
    monkeypatch.setattr(program_maker, "can_compile_ahead", lambda *_: True)
    for name in ("BackgroundCompiler", "EmptyDispatch"):
        monkeypatch.setattr(program_maker, name, lambda *_: collected)
    for name in ("load", "holds"):
        monkeypatch.setattr(BinaryCache, name, lambda *_: False)
    return collected.texts


@pytest.fixture
def library(device, submitted):
    library = ProgramLibrary(device[0])
    yield library
    library.release()


@pytest.mark.parametrize("feature", FEATURES)
@pytest.mark.parametrize("space", [REC709, ACESCG], ids=lambda space: space.name)
def test_a_picture_asks_for_nothing_that_was_not_prepared(library, submitted, feature, space):
    sent, scene = [], dataclasses.replace(with_material(feature), working_space=space.name)
    preparation = Preparation(library.context, library, lambda kind, **_: sent.append(kind))
    preparation.show(dataclasses.replace(scene, meshes=[], instances=[], lights=[]), 1, False)
    run_to_the_end(preparation)
    assert sent == ["prepared"]
    before = library.made, set(submitted)
    StageSet(library.context, library, scene, demands_of(scene, 1.0)).release()
    for material in scene.materials:
        assert all(program.has_stand_in(library) for program in programs_of(material))
    assert (library.made, submitted) == before


def test_stand_ins_wait_for_programs_of_the_working_space(library, submitted):
    scene = dataclasses.replace(with_material(wax), working_space=ACESCG.name)
    StandIns(library).replace(scene)
    before = set(submitted)
    StandIns(library).replace(dataclasses.replace(scene, working_space=REC709.name))
    assert before and len(submitted) == 2 * len(before)


def test_what_a_driver_refuses_is_left_to_whoever_renders(library, monkeypatch):
    def refuse(*_):
        raise CompileError("no")

    sent = []
    monkeypatch.setattr(library, "compute", refuse)
    preparation = Preparation(library.context, library, lambda kind, **_: sent.append(kind))
    preparation.show(floor_scene(), 1, False)
    run_to_the_end(preparation)
    assert sent == ["prepared"]


@pytest.mark.parametrize("feature", FEATURES)
def test_the_stages_of_stand_ins_are_those_of_what_they_stand_for(library, feature):
    """Else they would be made anew when the materials come, and their programs compiled while the picture rests."""
    scene = with_material(feature)
    shown = StandIns(library).replace(scene)
    (material,) = shown.materials[1:]
    assert material is not scene.materials[1] and material.graph.displacement is None
    demands = demands_of(shown, 1.0, scene.materials)
    assert StageSizes.of(shown, demands) == StageSizes.of(scene, demands_of(scene, 1.0))
    assert demands.traces_rays == (feature is occluded)


def test_a_displacement_is_waited_for_though_its_surface_is_ready(library, monkeypatch):
    scene = with_material(displaced)
    found = StandIns(library)
    found.replace(scene)
    assert found.count == 2  # both surfaces are the same
    monkeypatch.setattr(Collected, "has_tried", lambda self, source: "material_displacement" not in source.text)
    assert not found.due
    shown = found.replace(scene)
    changed = [a is not b for a, b in zip(scene.materials, shown.materials, strict=True)]
    assert found.count == 1 and changed == [False, True]
    monkeypatch.setattr(Collected, "has_tried", lambda self, source: True)
    assert found.due and found.replace(scene) is scene


def test_a_scene_is_known_with_its_displacement_only():
    scene, known = with_material(displaced), KnownPrograms()
    surface, displacement = programs_of(scene.materials[1])
    rendered = SimpleNamespace(programs=[surface.text], displacing={})
    known.add(rendered)
    assert known.cover(floor_scene()) and not known.cover(scene)
    rendered.displacing = {1: displacement}
    known.add(rendered)
    assert known.cover(scene)
