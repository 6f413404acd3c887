# SPDX-License-Identifier: GPL-3.0-or-later
"""LuxCore by pyluxcore. Option engine: photongi or light_tracing.

Its bidirectional engine (BIDIRCPU) is left out: in two of the scenes its means are 5 % and 10 % above those of path
tracing by Cycles, Mitsuba and LuxCore itself, whatever filter and sampler.
"""

import math
import sys
import time

import numpy as np
import pyluxcore

from ..description import AreaLight, Diffuse, Glass, Light, Material, Mesh, Mirror, Scene, SphereLight, SunLight
from ..jobs import DEPTH, Job, Recorder, run_adapter

_POLL_SECONDS = 0.02
_PATH = {
    "renderengine.type": "PATHCPU",
    "sampler.type": "SOBOL",
    "path.pathdepth.total": DEPTH,
    "path.pathdepth.diffuse": DEPTH,
    "path.pathdepth.glossy": DEPTH,
    "path.pathdepth.specular": DEPTH,
    "path.clamping.variance.maxvalue": 0.0,
}
ENGINES: dict[str, dict[str, object]] = {
    "photongi": {
        **_PATH,
        "path.photongi.sampler.type": "METROPOLIS",
        "path.photongi.photon.maxcount": 500_000,
        "path.photongi.photon.maxdepth": DEPTH,
        "path.photongi.photon.time.start": 0.0,
        # Fewer visibility samples than by default: the scenes are small, and those would take seconds.
        "path.photongi.visibility.lookup.radius": 0.06,
        "path.photongi.visibility.maxsamplecount": 65536,
        "path.photongi.indirect.enabled": False,
        "path.photongi.caustic.enabled": True,
        "path.photongi.caustic.maxsize": 30_000,
        "path.photongi.caustic.lookup.radius": 0.05,
        "path.photongi.caustic.lookup.normalangle": 10.0,
        "path.photongi.caustic.updatespp": 8,
        "path.photongi.caustic.updatespp.radiusreduction": 0.96,
        "path.photongi.caustic.updatespp.minradius": 0.003,
    },
    "light_tracing": {
        **_PATH,
        "path.hybridbackforward.enable": True,
        "path.hybridbackforward.partition": 0.7,
        "path.hybridbackforward.glossinessthreshold": 0.05,
    },
}


def render(job: Job, scene: Scene, recorder: Recorder) -> None:
    pyluxcore.Init(lambda message: None)
    _run(job, scene, [], 1, lambda *_: recorder.first_picture())
    _run(job, scene, job.seconds, 0, recorder.keep)


def _run(job: Job, scene: Scene, marks: list[float], passes: int, keep) -> None:
    """Render anew until the last mark, or as many passes; the scene's own description is made before the clock."""
    described = _scene(scene, job.resolution)
    configuration = _properties(
        {
            **ENGINES[str(job.options["engine"])],
            "film.width": job.resolution,
            "film.height": job.resolution,
            "film.filter.type": "BLACKMANHARRIS",
            "film.filter.xwidth": 1.5,
            "film.filter.ywidth": 1.5,
            "film.outputs.0.type": "RGB",
            "film.outputs.0.filename": "unused.exr",
            "renderengine.seed": job.seed,
            "batch.haltspp": 0,
        }
    )
    start = time.perf_counter()
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(configuration, described))
    session.Start()
    try:
        pending = list(marks)
        while pending or passes:
            time.sleep(_POLL_SECONDS)
            seconds = time.perf_counter() - start
            session.UpdateStats()
            done = session.GetStats().Get("stats.renderengine.pass").GetFloat()
            if passes and done >= passes:
                return keep(0.0, seconds, done, _film(session, job.resolution))
            if pending and seconds >= pending[0]:
                pixels = _film(session, job.resolution)
                keep(pending.pop(0), time.perf_counter() - start, done, pixels)
    finally:
        session.Stop()


def _film(session, resolution: int) -> np.ndarray:
    pixels = np.zeros(resolution * resolution * 3, np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, True)
    return pixels.reshape(resolution, resolution, 3)[::-1]


def _properties(values: dict[str, object]):
    made = pyluxcore.Properties()
    for name, value in values.items():
        made.Set(pyluxcore.Property(name, list(value) if isinstance(value, tuple | list) else value))
    return made


def _scene(scene: Scene, resolution: int):
    made = pyluxcore.Scene()
    values: dict[str, object] = {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": scene.camera.position,
        "scene.camera.lookat.target": scene.camera.target,
        "scene.camera.up": (0.0, 0.0, 1.0),
        "scene.camera.fieldofview": math.degrees(scene.camera.angle),
        # LuxCore's rows lie one pixel too low: measured against Cycles and Mitsuba.
        "scene.camera.screenwindow": (-1.0, 1.0, -1.0 - 2.0 / resolution, 1.0 - 2.0 / resolution),
        "scene.camera.autovolume.enable": False,
        "scene.camera.cliphither": 0.01,
    }
    for index, mesh in enumerate(scene.meshes):
        values |= _material(f"scene.materials.m{index}.", mesh.material)
        _add_mesh(made, f"mesh{index}", mesh)
        values |= {f"scene.objects.o{index}.shape": f"mesh{index}", f"scene.objects.o{index}.material": f"m{index}"}
    for index, light in enumerate(scene.lights):
        values |= _light(made, index, light)
    if scene.world > 0.0:
        values |= {"scene.lights.world.type": "constantinfinite", "scene.lights.world.color": (scene.world,) * 3}
    made.Parse(_properties(values))
    return made


def _add_mesh(made, name: str, mesh: Mesh) -> None:
    normals = None if mesh.normals is None else list(map(tuple, mesh.normals.tolist()))
    vertices, triangles = map(tuple, mesh.vertices.tolist()), map(tuple, mesh.triangles.tolist())
    made.DefineMesh(name, list(vertices), list(triangles), normals, None, None, None)


def _material(prefix: str, material: Material) -> dict[str, object]:
    match material:
        case Diffuse(color):
            return {prefix + "type": "matte", prefix + "kd": color}
        case Mirror(color):
            return {prefix + "type": "mirror", prefix + "kr": color}
        case Glass(ior):
            white = {prefix + "kr": (1.0, 1.0, 1.0), prefix + "kt": (1.0, 1.0, 1.0)}
            return {prefix + "type": "glass", prefix + "interiorior": ior, prefix + "exteriorior": 1.0, **white}


def _light(made, index: int, light: Light) -> dict[str, object]:
    prefix = f"scene.lights.l{index}."
    match light:
        case AreaLight():
            made.DefineMesh(
                f"light{index}", [*map(tuple, light.corners.tolist())], [(0, 1, 2), (0, 2, 3)], None, None, None, None
            )
            material = f"scene.materials.l{index}."
            return {
                material + "type": "matte",
                material + "kd": (0.0, 0.0, 0.0),
                material + "emission": tuple(light.radiance * value for value in light.color),
                f"scene.objects.l{index}.shape": f"light{index}",
                f"scene.objects.l{index}.material": f"l{index}",
            }
        case SphereLight():
            return {
                prefix + "type": "sphere",
                prefix + "position": light.position,
                prefix + "radius": light.radius,
                prefix + "color": tuple(light.power * value for value in light.color),  # watts: measured
            }
        case SunLight():
            return {
                prefix + "type": "distant",
                prefix + "direction": light.direction,
                prefix + "theta": math.degrees(0.5 * light.angle),
                prefix + "color": tuple(light.radiance * value for value in light.color),
            }
    raise ValueError(f"LuxCore has no light of the kind {type(light).__name__}")


if __name__ == "__main__":
    sys.exit(run_adapter(lambda: f"LuxCore {pyluxcore.Version()}", render))
