# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that a file may use and no picture of RPPM shows, so that no export leaves them out in silence.

Nodes say so where they are exported (shading/nodes/), as do objects of kinds that have no surface
(instances/instance_reader.py).
"""

from .object_omissions import OF_OBJECTS
from .omission import Omission
from .omission_list import OmissionList, objects_of
from .pass_omissions import PASSES
from .scene_omissions import OF_SCENES

__all__ = ["OF_OBJECTS", "OF_SCENES", "PASSES", "Omission", "OmissionList", "objects_of"]
