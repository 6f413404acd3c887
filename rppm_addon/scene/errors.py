# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that a user can do something about. Every message names the thing and the remedy."""


class RppmError(Exception):
    """Base of the errors that the engine reports to the user as one line."""


class SceneError(RppmError):
    """The scene cannot be rendered as it is."""


class SettingsError(RppmError):
    """A setting has a value that cannot be used."""


class CheckpointError(RppmError):
    """A checkpoint cannot be read, gone on from or merged."""


class DeviceError(RppmError):
    """The graphics device or its driver cannot do what is asked."""


class DeviceLostError(DeviceError):
    """The driver has reset the graphics device: another context is needed, and all that was on the device again."""


class DenoiserError(RppmError):
    """There is no library that denoises, or it cannot be used."""


class RendererError(RppmError):
    """The renderer's process has failed."""


NO_MEMORY = "there is not enough memory; lower the resolution, simplify the scene, or close other programs"


def unforeseen(error: Exception, remedy: str) -> str:
    """Return the message to users for an error that is none of the above. A lack of memory has a remedy of its own."""
    if isinstance(error, MemoryError):
        return NO_MEMORY
    return f"RPPM failed unexpectedly ({type(error).__name__}: {error}); {remedy}"
