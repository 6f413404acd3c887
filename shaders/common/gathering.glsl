// SPDX-License-Identifier: GPL-3.0-or-later
#include <Importon>
#include <GatheringVertex>

#include <GatherFlags>
#include <PhotonFactor>
