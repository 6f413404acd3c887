# SPDX-License-Identifier: GPL-3.0-or-later
"""All that an export gives of the current scene, as a value that can be compared."""

from support.moving import taken_scene

from rppm_addon.scene.storage.fingerprint import scene_digests


def signature() -> tuple[object, ...]:
    """Return digests of the exported scene, its settings, warnings and stamps; the error where there is no scene."""
    try:
        scene = taken_scene()
    except (AssertionError, RuntimeError) as error:
        return (str(error),)
    stamps = sorted((name, value if name != "Date" else "") for name, value in scene.stamps.items())
    return scene_digests(scene), repr(scene.settings), tuple(scene.warnings), stamps
