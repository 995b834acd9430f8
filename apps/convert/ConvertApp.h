// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace pointplane
{
/** pointplane-convert without the process around it.
 * \param args the command line without the program's name
 * \return the exit code (mrpt_io/errors.h) */
int runConvert(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);
}  // namespace pointplane
