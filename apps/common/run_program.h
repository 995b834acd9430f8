// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace pointplane
{
/** Parses the command line and runs `body`; whatever goes wrong is one line on `err`.
 * \param args without the program's name
 * \return the exit code (mrpt_io/errors.h) */
[[nodiscard]] int runCommand(
    CLI::App& app,
    const std::vector<std::string>& args,
    std::ostream& out,
    std::ostream& err,
    const std::function<int()>& body);

using Program = int (*)(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);

/** main() of all programs: what a process needs beyond the command itself. A limit on the size of
 * files is an error like a full disk, a small stack is replaced by one of its own, and a standard
 * output that could not be written is an error. */
[[nodiscard]] int runProgram(const char* name, Program program, int argc, char** argv);
}  // namespace pointplane
