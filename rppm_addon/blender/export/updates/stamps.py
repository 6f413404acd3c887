# SPDX-License-Identifier: GPL-3.0-or-later
"""Metadata that Blender writes into files of pictures about where these come from, as far as users want it."""

import datetime

import bpy


def export_stamps(scene: bpy.types.Scene) -> dict[str, str]:
    """By Blender's names of the attributes; Output > Metadata says which. scene: the evaluated one."""
    render = scene.render
    found = {}
    if render.use_stamp_date:
        found["Date"] = datetime.datetime.now().strftime("%Y/%m/%d %H:%M:%S")
    if render.use_stamp_time:
        found["Time"] = _timecode(scene)
    if render.use_stamp_frame:
        found["Frame"] = f"{scene.frame_current:0{len(str(scene.frame_end))}d}"
    if render.use_stamp_camera and scene.camera is not None:
        found["Camera"] = scene.camera.name
    if render.use_stamp_scene:
        found["Scene"] = scene.name
    if render.use_stamp_filename:
        found["File"] = bpy.data.filepath or "<untitled>"
    if render.use_stamp_note and render.stamp_note_text:
        found["Note"] = render.stamp_note_text
    return found


def _timecode(scene: bpy.types.Scene) -> str:
    """Hours, minutes, seconds and frames of the current frame (SMPTE)."""
    rate = scene.render.fps / scene.render.fps_base
    seconds = abs(scene.frame_current) / rate
    whole = int(seconds)
    frames = round((seconds - whole) * rate)
    if frames >= round(rate):
        whole, frames = whole + 1, 0
    sign = "-" if scene.frame_current < 0 else ""
    return f"{sign}{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}:{frames:02d}"
