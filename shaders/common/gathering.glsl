// SPDX-License-Identifier: GPL-3.0-or-later
#include <Importon>
#include <GatherFlags>
#include <ImportonMedia>
#include <PhotonFactor>
