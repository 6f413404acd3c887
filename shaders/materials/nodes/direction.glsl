// SPDX-License-Identifier: GPL-3.0-or-later

// `direction` is what the user turned the node's ball to, a constant.
void node_normal(vec3 normal, vec3 direction, out vec3 chosen, out float cosine) {
    chosen = direction;
    cosine = dot(direction, normalize(normal));
}
