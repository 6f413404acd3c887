// SPDX-License-Identifier: GPL-3.0-or-later
#include <CameraPath>
#include <CameraPathFlags>
#include <CameraPathsInMedia>
