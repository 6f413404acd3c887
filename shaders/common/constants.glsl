// SPDX-License-Identifier: GPL-3.0-or-later
const float PI = 3.14159265358979;
const float INFINITY_DISTANCE = 1e30;
const uint NO_TRIANGLE = 0xffffffffu;
