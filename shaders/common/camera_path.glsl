// SPDX-License-Identifier: GPL-3.0-or-later
#include <CameraPath>
#include <CameraPathFlags>
#include <CameraPathsInMedia>
#include <RayPortalPaths>

// The least pdf of a path that no lobe has scattered.
const float NO_PDF = 1e30;
