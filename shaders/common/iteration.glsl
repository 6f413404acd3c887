// SPDX-License-Identifier: GPL-3.0-or-later
// What many programs need to know of the iteration (integrator/device_scene/iteration_parameters.py).

#include <IterationParameters>
uniform Iteration { IterationParameters iteration; };
