// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace pointplane
{
/** pointplane-simulate without the process around it.
 * \param args the command line without the program's name
 * \return the exit code: 0 ok; 2 bad usage or input; 3 output cannot be written */
int runSimulate(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);
}  // namespace pointplane
