// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace pointplane
{
/** Something that the user gave is wrong: a missing file, an unknown key, a wrong label. The
 * message is one line that names it. Applications exit with kExitBadInput. */
class InputError : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** Something is wrong with the machine: disk full, unwritable output, no device. The message is one
 * line. Applications exit with kExitEnvironment. */
class EnvironmentError : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** @name Exit codes of all applications
 * @{ */
constexpr int kExitOk = 0;
/** The input was damaged, or frames could not be used (the rest is done), or less than half of the
 * frames were tracked; of pointplane-eval, also: a threshold was not kept. */
constexpr int kExitIncomplete = 1;
/** Bad usage or input: missing file, unknown key, wrong label. */
constexpr int kExitBadInput = 2;
/** The machine: output not writable, disk full. Or an internal error. */
constexpr int kExitEnvironment = 3;
/** @} */

/** The message of an exception; of MRPT's and OpenCV's, which have many lines, the first sentence.
 * Names of files may hold control characters: they become '?'. */
[[nodiscard]] std::string oneLine(const std::exception& e);

/** Why there is no file to read: "no such file", "not a file", or what the system says. */
[[nodiscard]] std::string whyNoFile(const std::string& path);

/** Whether it is about the machine, not about what was read: std::bad_alloc, and OpenCV's own. */
[[nodiscard]] bool isOutOfMemory(const std::exception& e);
}  // namespace pointplane
