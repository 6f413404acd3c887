# SPDX-License-Identifier: GPL-3.0-or-later
"""Stand-ins for fluid domains of gas, which nothing here can bake."""

from types import SimpleNamespace


def domain_of_gas(counts=(3, 2, 4), **grids):
    """A mesh object with a domain, whose grids (z, y, x, channels) are flat."""
    empty = {f"{name}_grid": [] for name in ("density", "flame", "temperature", "color", "heat", "velocity")}
    settings = SimpleNamespace(domain_type="GAS", domain_resolution=counts, velocity_scale=2.0, **(empty | grids))
    shown = {"show_render": True, "show_viewport": True}
    modifier = SimpleNamespace(type="FLUID", fluid_type="DOMAIN", domain_settings=settings, **shown)
    data = SimpleNamespace(texspace_location=(1.0, 0.0, 0.0), texspace_size=(3.0, 2.0, 4.0))
    return SimpleNamespace(type="MESH", modifiers=[modifier], data=data)
