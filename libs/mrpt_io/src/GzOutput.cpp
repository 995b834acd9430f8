// SPDX-License-Identifier: BSD-3-Clause
#include "GzOutput.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>

namespace pointplane
{
namespace
{
constexpr int kGzFormat = 15 + 16;  // zlib: largest window, gz header and trailer
}

GzOutput::GzOutput(const std::string& path, int compressionLevel)
    : file_(path), compressed_(1U << 18U)
{
    const int level = std::clamp(compressionLevel, 0, 9);
    if (deflateInit2(&zlib_, level, Z_DEFLATED, kGzFormat, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    {
        throw EnvironmentError("cannot write " + path + ": out of memory");
    }
}

GzOutput::~GzOutput() { deflateEnd(&zlib_); }

void GzOutput::deflateInput(int flushMode)
{
    // After a failed write zlib still points to bytes of a caller who is gone.
    if (!usable_)
    {
        throw EnvironmentError("cannot write " + file_.writtenPath() + ": an earlier write failed");
    }
    usable_ = false;
    do
    {
        zlib_.next_out = compressed_.data();
        zlib_.avail_out = static_cast<uInt>(compressed_.size());
        deflate(&zlib_, flushMode);
        file_.write(compressed_.data(), compressed_.size() - zlib_.avail_out);
    } while (zlib_.avail_out == 0);
    usable_ = true;
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

void GzOutput::commit()
{
    deflateInput(Z_FINISH);
    file_.commit();
}
}  // namespace pointplane
