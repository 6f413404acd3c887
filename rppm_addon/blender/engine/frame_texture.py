# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame as a texture in Blender's window."""

from ...session.transport.frames import SharedFrame


class FrameTexture:
    """Uploads each frame once. Textures live as long as Blender's window, so it is used while drawing only."""

    def __init__(self) -> None:
        self._texture = None
        self._sequence = 0

    def draw(self, frame: SharedFrame, x: float, y: float, width: float, height: float) -> None:
        """Draw a frame, scene-linear and premultiplied, at a place in pixels; Blender applies the view transform."""
        import gpu  # at registration it would break Blender without a window
        from gpu_extras.presets import draw_texture_2d

        if self._texture is None or frame.sequence != self._sequence:
            data = gpu.types.Buffer("FLOAT", frame.combined.size, frame.combined.reshape(-1))
            self._texture = gpu.types.GPUTexture((frame.width, frame.height), format="RGBA16F", data=data)
            if hasattr(self._texture, "filter_mode"):  # Blender 5.0 and later: coarse frames are drawn smoothly
                self._texture.filter_mode(True)
            self._sequence = frame.sequence
        gpu.state.blend_set("ALPHA_PREMULT")
        draw_texture_2d(self._texture, (x, y), width, height)
        gpu.state.blend_set("NONE")
