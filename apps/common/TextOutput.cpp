// SPDX-License-Identifier: BSD-3-Clause
#include "TextOutput.h"

#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstring>

namespace pointplane
{
TextOutput::TextOutput(const std::string& path) : path_(path)
{
    file_.reset(std::fopen((path + ".partial").c_str(), "we"));
    if (!file_)
    {
        fail("create");
    }
}

void TextOutput::fail(const char* action) const
{
    throw EnvironmentError(
        std::string("cannot ") + action + " " + path_ + ".partial: " + std::strerror(errno));
}

void TextOutput::writeLine(const std::string& line)
{
    const std::string text = line + "\n";
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
        std::fflush(file_.get()) != 0)
    {
        fail("write");
    }
}

void TextOutput::close()
{
    if (std::fclose(file_.release()) != 0)
    {
        fail("write");
    }
    if (std::rename((path_ + ".partial").c_str(), path_.c_str()) != 0)
    {
        fail("rename");
    }
}
}  // namespace pointplane
