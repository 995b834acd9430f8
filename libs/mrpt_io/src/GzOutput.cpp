// SPDX-License-Identifier: BSD-3-Clause
#include "GzOutput.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
constexpr int kGzFormat = 15 + 16;  // zlib: largest window, gz header and trailer
}

GzOutput::GzOutput(const std::string& path, int compressionLevel)
    : path_(path), compressed_(1U << 18U)
{
    fd_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd_ < 0)
    {
        fail("create");
    }
    const int level = std::clamp(compressionLevel, 0, 9);
    if (deflateInit2(&zlib_, level, Z_DEFLATED, kGzFormat, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    {
        ::close(fd_);
        throw EnvironmentError("cannot write " + path + ": out of memory");
    }
}

GzOutput::~GzOutput()
{
    deflateEnd(&zlib_);
    ::close(fd_);
}

void GzOutput::fail(const char* action) const
{
    throw EnvironmentError(
        std::string("cannot ") + action + " " + path_ + ": " + std::strerror(errno));
}

void GzOutput::writeToFile(const std::uint8_t* bytes, std::size_t size)
{
    while (size > 0)
    {
        const ssize_t n = ::write(fd_, bytes, size);
        if (n < 0 && errno == EINTR)
        {
            continue;
        }
        if (n < 0)
        {
            fail("write");
        }
        bytes += n;
        size -= static_cast<std::size_t>(n);
    }
}

void GzOutput::deflateInput(int flushMode)
{
    do
    {
        zlib_.next_out = compressed_.data();
        zlib_.avail_out = static_cast<uInt>(compressed_.size());
        deflate(&zlib_, flushMode);
        writeToFile(compressed_.data(), compressed_.size() - zlib_.avail_out);
    } while (zlib_.avail_out == 0);
}

void GzOutput::write(const void* bytes, std::size_t size)
{
    const auto* next = static_cast<const std::uint8_t*>(bytes);
    while (size > 0)
    {
        const std::size_t chunk = std::min<std::size_t>(size, 1U << 30U);
        zlib_.next_in = const_cast<std::uint8_t*>(next);  // zlib does not write to it
        zlib_.avail_in = static_cast<uInt>(chunk);
        deflateInput(Z_NO_FLUSH);
        next += chunk;
        size -= chunk;
    }
}

void GzOutput::flush() { deflateInput(Z_SYNC_FLUSH); }

void GzOutput::finish()
{
    deflateInput(Z_FINISH);
    // EINVAL: the file is a pipe or the like, where there is nothing to wait for.
    if (::fsync(fd_) != 0 && errno != EINVAL)
    {
        fail("write");
    }
}
}  // namespace pointplane
