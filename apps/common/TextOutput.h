// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace pointplane
{
/** A text file that appears under its name when it is complete; until then it is `<path>.partial`.
 * Every write is checked and reaches the operating system with its line.
 * All members throw EnvironmentError naming the file. */
class TextOutput
{
 public:
    explicit TextOutput(const std::string& path);

    void writeLine(const std::string& line);
    /** Completes and renames the file. */
    void close();

    [[nodiscard]] const std::string& path() const { return path_; }

 private:
    struct Closer
    {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    [[noreturn]] void fail(const char* action) const;

    std::string path_;
    std::unique_ptr<std::FILE, Closer> file_;
};
}  // namespace pointplane
