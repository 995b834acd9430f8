// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace pointplane
{
/** pointplane-grabber without its process. \param args without the program's name
 * \return exit code */
int runGrabber(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);
}  // namespace pointplane
