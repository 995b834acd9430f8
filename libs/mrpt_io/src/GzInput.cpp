// SPDX-License-Identifier: BSD-3-Clause
#include "GzInput.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/stat.h>

namespace pointplane
{
namespace
{
constexpr int kGzFormat = 15 + 16;
constexpr std::uint8_t kGzMagic[2] = {0x1f, 0x8b};
constexpr std::uint8_t kZstdMagic[4] = {0x28, 0xb5, 0x2f, 0xfd};
}  // namespace

GzInput::GzInput(const std::string& path) : buffer_(1U << 18U)
{
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0)
    {
        throw InputError("cannot open " + path + ": " + std::strerror(errno));
    }
    if (S_ISDIR(info.st_mode))
    {
        throw InputError("cannot open " + path + ": is a directory");
    }
    file_.reset(std::fopen(path.c_str(), "rbe"));
    if (!file_)
    {
        throw InputError("cannot open " + path + ": " + std::strerror(errno));
    }
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // buffer_ is the buffer
    fileSize_ = static_cast<std::uint64_t>(info.st_size);
    if (!refill())
    {
        throw InputError(path + ": is empty");
    }
    const auto startsWith = [this](const auto& magic)
    {
        return zlib_.avail_in >= sizeof(magic) &&
               std::equal(std::begin(magic), std::end(magic), zlib_.next_in);
    };
    if (startsWith(kZstdMagic))
    {
        throw InputError(
            path +
            ": is zstd-compressed, the default since MRPT 2.15.7; recompress it with: zstd -dc " +
            path + " | gzip > new.rawlog");
    }
    compressed_ = startsWith(kGzMagic);
    if (compressed_ && inflateInit2(&zlib_, kGzFormat) != Z_OK)
    {
        throw EnvironmentError("cannot read " + path + ": out of memory");
    }
}

GzInput::~GzInput()
{
    if (compressed_)
    {
        inflateEnd(&zlib_);
    }
}

std::uint64_t GzInput::fileOffset() const { return fileRead_ - zlib_.avail_in; }

bool GzInput::refill()
{
    const std::size_t n = std::fread(buffer_.data(), 1, buffer_.size(), file_.get());
    if (n == 0 && std::ferror(file_.get()) != 0)
    {
        finish(End::Damaged, std::strerror(errno));
    }
    fileRead_ += n;
    zlib_.next_in = buffer_.data();
    zlib_.avail_in = static_cast<uInt>(n);
    return n > 0;
}

void GzInput::finish(End end, const std::string& problem)
{
    if (end_ == End::Open)
    {
        end_ = end;
        problem_ = problem;
    }
}

void GzInput::startNextMember()
{
    if (zlib_.avail_in == 0 && !refill())
    {
        finish(End::Clean);
        return;
    }
    // zlib itself ignores what follows; here it would hide a damaged second stream.
    if (*zlib_.next_in != kGzMagic[0])
    {
        finish(End::Damaged, "bytes after the end of the compressed data");
        return;
    }
    inflateReset(&zlib_);
}

void GzInput::inflateInto(std::uint8_t* bytes, std::size_t size)
{
    zlib_.next_out = bytes;
    zlib_.avail_out = static_cast<uInt>(size);
    while (zlib_.avail_out > 0 && end_ == End::Open)
    {
        if (zlib_.avail_in == 0 && !refill())
        {
            finish(End::Truncated, "the compressed data stop too early");
            break;
        }
        const int code = inflate(&zlib_, Z_NO_FLUSH);
        if (code == Z_STREAM_END)
        {
            startNextMember();
        }
        else if (code != Z_OK && code != Z_BUF_ERROR)
        {
            finish(End::Damaged, zlib_.msg != nullptr ? zlib_.msg : "not gz data");
        }
    }
}

std::size_t GzInput::read(void* bytes, std::size_t size)
{
    auto* out = static_cast<std::uint8_t*>(bytes);
    std::size_t done = 0;
    while (done < size && end_ == End::Open)
    {
        const std::size_t chunk = std::min<std::size_t>(size - done, 1U << 30U);
        if (compressed_)
        {
            inflateInto(out + done, chunk);
            done += chunk - zlib_.avail_out;
            continue;
        }
        if (zlib_.avail_in == 0 && !refill())
        {
            finish(End::Clean);
            break;
        }
        const std::size_t n = std::min<std::size_t>(chunk, zlib_.avail_in);
        std::memcpy(out + done, zlib_.next_in, n);
        zlib_.next_in += n;
        zlib_.avail_in -= static_cast<uInt>(n);
        done += n;
    }
    return done;
}
}  // namespace pointplane
