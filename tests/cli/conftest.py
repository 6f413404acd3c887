# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the rppm program, and ways to run it: as its users do, and in the process of the tests."""

import contextlib
import io
import logging
import os
import subprocess
import sys
import time
from unittest import mock

import pytest
from support.floor import floor_scene

from rppm_addon import cli
from rppm_addon.scene import save_scene


def start_rppm(*arguments, errors=subprocess.PIPE):
    """The program as a process with pipes, or what ``errors`` says for standard error."""
    command = [sys.executable, "-m", "rppm_addon", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)


def rppm_here(*arguments):
    """Run the program in this process, on what is no .blend file: exit status, standard output, standard error.

    It takes a third of what a process of its own takes; where that is not the subject, tests run it so.
    """
    root, output, errors = logging.getLogger(), io.StringIO(), io.StringIO()
    handlers, level = root.handlers[:], root.level
    try:
        with mock.patch.dict(os.environ), contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            status = cli.main([str(argument) for argument in arguments])
    except SystemExit as end:  # of what argparse refuses
        status = end.code
    finally:
        root.handlers[:] = handlers
        root.setLevel(level)
    return status, output.getvalue(), errors.getvalue()


def succeed(run, *arguments, **options):
    """Run the program by ``rppm`` or ``rppm_here``, which must succeed: standard output, standard error."""
    status, output, errors = run(*arguments, **options)
    assert status == 0, errors
    return output, errors


def interrupt(process, number, is_ready):
    """Send the program a signal once something is there, and wait for its end: standard error."""
    give_up = time.monotonic() + 90.0
    while not is_ready() and process.poll() is None and time.monotonic() < give_up:
        time.sleep(0.01)
    process.send_signal(number)
    try:
        _, errors = process.communicate(timeout=60)
    finally:
        process.kill()
    assert "Traceback" not in errors
    return errors


@pytest.fixture
def rppm():
    """Run the program as a process: returns exit status, standard output, standard error."""

    def run(*arguments, timeout=120):
        with start_rppm(*arguments) as process:
            try:
                output, errors = process.communicate(timeout=timeout)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
        return process.returncode, output, errors

    return run


@pytest.fixture
def saved_scene(tmp_path):
    """The floor as a .npz."""
    path = tmp_path / "floor.npz"
    save_scene(floor_scene(), path)
    return path


_IN_BLENDER = """
import sys
import bpy
import rppm_addon
rppm_addon.register()
{}
rppm_addon.unregister()
"""
_MAKE_BLEND = """
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
bpy.ops.mesh.primitive_plane_add(size=18, location=(-9, 0, 0))
light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
light.location, light.data.energy = (-1, 1, 2), 300
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.location = (0, 0, 4)
for made in (light, camera):
    scene.collection.objects.link(made)
light.keyframe_insert("location", frame=1)
light.location.x = -90
light.keyframe_insert("location", frame=2)
for frame, length in (4, 0), (5, 1), (6, 0):
    scene.rppm.radius_minimum, scene.rppm.radius_maximum = 2 * length, length
    scene.rppm.keyframe_insert("radius_minimum", frame=frame)
    scene.rppm.keyframe_insert("radius_maximum", frame=frame)
scene.frame_set(1)
scene.camera = camera
scene.render.engine = "RPPM"
scene.render.resolution_x, scene.render.resolution_y = 16, 12
scene.rppm.samples, scene.rppm.photons = 3, 1024
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[1])
scene.camera = None
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
"""


def run_in_blender(code, *arguments):
    """Run code in a process with Blender's module and RPPM registered there."""
    command = [sys.executable, "-c", _IN_BLENDER.format(code), *map(str, arguments)]
    subprocess.run(command, check=True, timeout=120, capture_output=True)


@pytest.fixture(scope="session")
def blend_files(tmp_path_factory):
    """The same floor as a .blend whose light is gone in frame 2, and whose settings cannot be used in frame 5; and that
    file without a camera."""
    pytest.importorskip("bpy", reason="the bpy module is not installed")
    folder = tmp_path_factory.mktemp("blend")
    paths = folder / "floor.blend", folder / "no_camera.blend"
    run_in_blender(_MAKE_BLEND, *paths)
    return paths
