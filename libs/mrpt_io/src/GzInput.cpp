// SPDX-License-Identifier: BSD-3-Clause
#include "GzInput.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "gz_members.h"
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
    expectHeader();
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

void GzInput::expectHeader()
{
    if (compressed_)
    {
        header_ = {};
        header_.extra = extra_;
        header_.extra_max = sizeof(extra_);
        inflateGetHeader(&zlib_, &header_);
        atMemberStart_ = true;
    }
}

bool GzInput::isLastMember() const
{
    return header_.extra_len < kAnotherFollows.size() ||
           !std::equal(kAnotherFollows.begin(), kAnotherFollows.end(), extra_);
}

void GzInput::startNextMember()
{
    keptAll_ = true;
    if (zlib_.avail_in == 0 && !refill())
    {
        isLastMember() ? finish(End::Clean)
                       : finish(End::Truncated, "the file stops between two records");
        return;
    }
    // zlib itself ignores what follows; here it would hide a damaged second stream.
    if (*zlib_.next_in != kGzMagic[0])
    {
        finish(End::Damaged, "bytes after the end of the compressed data");
        return;
    }
    inflateReset(&zlib_);
    expectHeader();
}

int GzInput::inflateSome()
{
    keeping_ = keeping_ && !keptAll_;  // else the object goes on in another member
    const std::uint8_t* from = zlib_.next_in;
    const int code = inflate(&zlib_, Z_NO_FLUSH);
    atMemberStart_ = false;
    if (keeping_)
    {
        kept_.insert(kept_.end(), from, static_cast<const std::uint8_t*>(zlib_.next_in));
    }
    return code;
}

void GzInput::beginMember()
{
    keeping_ = compressed_ && atMemberStart_ && end_ == End::Open;
    keptAll_ = false;
    kept_.clear();
}

std::vector<std::uint8_t> GzInput::endMember()
{
    // The end of the data and the checksum may still be to be read. Where more data come, zlib
    // waits for room to put them.
    std::uint8_t nothing = 0;
    zlib_.next_out = &nothing;
    zlib_.avail_out = 0;
    int code = Z_OK;
    while (keeping_ && !keptAll_ && code == Z_OK && (zlib_.avail_in > 0 || refill()))
    {
        code = inflateSome();
        if (code == Z_STREAM_END)
        {
            startNextMember();
        }
        else if (code != Z_OK && code != Z_BUF_ERROR)
        {
            finish(End::Damaged, zlib_.msg != nullptr ? zlib_.msg : "not gz data");
        }
    }
    const bool isWhole = keeping_ && keptAll_;
    keeping_ = false;
    return isWhole ? std::vector<std::uint8_t>(
                         kept_.begin() + static_cast<std::ptrdiff_t>(headerSize()), kept_.end())
                   : std::vector<std::uint8_t>();
}

std::size_t GzInput::headerSize() const
{
    constexpr std::uint8_t kChecksum = 2, kExtra = 4, kName = 8, kComment = 16;  // RFC 1952
    const std::uint8_t flags = kept_.at(3);
    std::size_t at = 10;
    if ((flags & kExtra) != 0)
    {
        at += 2U + kept_.at(at) + 256U * kept_.at(at + 1);
    }
    for (const std::uint8_t text : {kName, kComment})
    {
        while ((flags & text) != 0 && kept_.at(at++) != 0)
        {
        }
    }
    return (flags & kChecksum) != 0 ? at + 2 : at;
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
        const int code = inflateSome();
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

Checksums checksumsOf(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        return Checksums::None;
    }
    GzInput in(path);
    std::vector<std::uint8_t> chunk(1U << 20U);
    while (in.isCompressed() && in.read(chunk.data(), chunk.size()) == chunk.size())
    {
    }
    return in.end() == GzInput::End::Clean     ? Checksums::Right
           : in.end() == GzInput::End::Damaged ? Checksums::Wrong
                                               : Checksums::None;
}
}  // namespace pointplane
