// SPDX-License-Identifier: BSD-3-Clause
#include "standard_streams.h"

#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
bool outputIsClosed = false;

[[nodiscard]] bool isClosed(int stream) { return ::fcntl(stream, F_GETFD) < 0; }

/** Not /dev/null: who names /dev/stdout wants it to arrive, who names /dev/null does not. */
void openPipeThatNobodyReads(int stream)
{
    int ends[2] = {-1, -1};
    if (::pipe(ends) != 0)
    {
        return;
    }
    ::dup2(ends[1], stream);
    for (const int end : ends)
    {
        if (end != stream)
        {
            ::close(end);
        }
    }
}

[[noreturn]] void fail(const std::string& why)
{
    throw EnvironmentError("cannot write to the standard output" + why);
}
}  // namespace

void openStandardStreams()
{
    outputIsClosed = isClosed(STDOUT_FILENO);
    if (isClosed(STDIN_FILENO))
    {
        (void)!::open("/dev/null", O_RDONLY);  // takes the lowest number that is free
    }
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    {
        if (isClosed(stream))
        {
            openPipeThatNobodyReads(stream);
        }
    }
}

std::size_t columnsOf(int stream)
{
    winsize size = {};
    const bool tells = ::isatty(stream) == 1 && ::ioctl(stream, TIOCGWINSZ, &size) == 0;
    return tells ? size.ws_col : 0;
}

std::size_t helpColumns()
{
    const char* const told = std::getenv("COLUMNS");
    if (const auto columns = parseNumber<std::size_t>(told == nullptr ? "" : told))
    {
        return *columns;
    }
    const std::size_t columns = columnsOf(STDOUT_FILENO);
    return columns > 0 ? columns : columnsOf(STDERR_FILENO);
}

void requireStandardOutput()
{
    if (outputIsClosed)
    {
        fail(": it is closed");
    }
}

void flushStandardOutput()
{
    errno = 0;
    if (!std::cout.flush() && !outputIsClosed)
    {
        fail(errno != 0 ? std::string(": ") + std::strerror(errno) : "");
    }
}
}  // namespace pointplane
