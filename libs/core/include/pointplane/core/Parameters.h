// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/** \file
 * Parameter groups are plain structs with in-class defaults and two members:
 *
 *     template <class V> void visit(V&& v) { v("maxIterations", maxIterations, "-", "help"); }
 *     void check() const;   // throws std::invalid_argument naming the key
 *
 * `visit` is the only list of a group's keys. Ini files are read, written and documented through it
 * (mrpt_io/params_ini.h). Member types: bool, int, double, std::string. The ini key is the member's
 * name, the section the group's. Units are SI or in the key's name (`...Px`,
 * `...Deg`).
 */
