// SPDX-License-Identifier: GPL-3.0-or-later
// Stands for the storage blocks of media in programs for scenes that have none.
