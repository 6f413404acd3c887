// SPDX-License-Identifier: GPL-3.0-or-later
readonly buffer Media;
writeonly buffer ShadowMedia;
