# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL of the Bump node, which evaluates its height at three points of the surface."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Bump:
    """GLSL expressions of a Bump node's inputs."""

    height: str
    """Name of the function that returns the height at a point."""
    strength: str
    distance: str
    normal: str
    filter_width: str
    invert: str

    def statements(self, result: str) -> list[str]:
        """Return statements that declare and set a variable, the bumped normal."""
        return self._statements(result, [], self.normal, [], "surface_beside(surface, way)", "along", [])

    def undisplaced_statements(self, result: str, layer: str, normals: str) -> list[str]:
        """Return the same for a surface that is displaced as well, bumped in object space as it was before.

        layer, normals: GLSL for the numbers of the mesh attributes of its vertices and normals before.
        """
        return self._statements(
            result,
            [f"surface.normal = undisplaced_normal(surface, {normals});"],
            f"unit_to_object(surface, {self.normal})",
            [
                *(f"  vec3 way_{axis} = undisplaced_way(surface, along_{axis}, {layer});" for axis in "xy"),
                "  float stretch = undisplaced_stretch(surface, along_x, way_x, way_y);",
            ],
            f"undisplaced_beside(surface, way, stretch, {layer})",
            "way",
            [f"{result} = unit_to_world(surface, {result});"],
        )

    def _statements(
        self, result: str, before: list[str], normal: str, ways: list[str], there: str, along: str, after: list[str]
    ) -> list[str]:
        return [
            *before,
            f"vec3 {result};",
            f"{{ vec3 along_x, along_y, heights = vec3(0.0); "
            f"bump_offsets(surface, {self.filter_width}, along_x, along_y);",
            *ways,
            # A loop, so that drivers need not compile the height three times.
            "  for (int k = 0; k < 3; ++k) {",
            "    vec3 way = k == 0 ? vec3(0.0) : k == 1 ? along_x : along_y;",
            f"    float height = {self.height}({there}, first);",
            "    if (k == 0) heights.x = height; else if (k == 1) heights.y = height; else heights.z = height;",
            "  }",
            f"  node_bump(surface, {self.invert}, {self.strength}, {self.distance}, {normal}, {along}_x, {along}_y,",
            f"            heights.y - heights.x, heights.z - heights.x, {result}); }}",
            *after,
        ]
