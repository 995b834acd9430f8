// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/OutputFile.h>

#include <string>

namespace pointplane
{
/** A text file that is complete or marked as not (OutputFile). Every line reaches the operating
 * system at once. All members throw EnvironmentError naming the file. */
class TextOutput
{
 public:
    explicit TextOutput(const std::string& path) : file_(path) {}

    void writeLine(const std::string& line) { write(line + "\n"); }
    void write(const std::string& text) { file_.write(text.data(), text.size()); }
    /** Completes and renames the file. */
    void close() { file_.commit(); }
    /** Removes the partial file. */
    void discard() noexcept { file_.discard(); }

    [[nodiscard]] const std::string& path() const { return file_.path(); }

 private:
    OutputFile file_;
};
}  // namespace pointplane
