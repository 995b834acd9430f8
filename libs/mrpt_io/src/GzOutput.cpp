// SPDX-License-Identifier: BSD-3-Clause
#include "GzOutput.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <new>

#include "gz_members.h"
#include <libdeflate.h>

namespace pointplane
{
namespace
{
constexpr std::size_t kLargestMember = 1U << 24U;

// RFC 1952: magic, deflate, with an extra field; no time; no system. The field: its length, the
// identifier, no contents.
constexpr std::array<std::uint8_t, 16> kHeader{
    0x1f, 0x8b, 8, 4, 0, 0, 0, 0, 0, 255, 4, 0, kAnotherFollows[0], kAnotherFollows[1], 0, 0};
// Nothing compressed: a last block without contents, checksum and length.
constexpr std::array<std::uint8_t, 10> kEmptyBody{3, 0};
constexpr std::array<std::uint8_t, 20> kEmptyMember{
    0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255, kEmptyBody[0], kEmptyBody[1]};

void appendLittleEndian(std::uint32_t value, std::vector<std::uint8_t>& out)
{
    for (unsigned shift = 0; shift < 32; shift += 8)
    {
        out.push_back(static_cast<std::uint8_t>(value >> shift));
    }
}
}  // namespace

void GzOutput::Freer::operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }

GzOutput::GzOutput(const std::string& path, int compressionLevel)
    : file_(path), compressor_(libdeflate_alloc_compressor(std::clamp(compressionLevel, 0, 9)))
{
    if (!compressor_)
    {
        throw std::bad_alloc();
    }
    file_.write(kHeader.data(), kHeader.size());
}

void GzOutput::write(const void* bytes, std::size_t size)
{
    const auto* from = static_cast<const std::uint8_t*>(bytes);
    member_.insert(member_.end(), from, from + size);
    if (member_.size() >= kLargestMember)
    {
        flush();
    }
}

void GzOutput::flush()
{
    if (member_.empty())
    {
        return;
    }
    compressed_.resize(libdeflate_deflate_compress_bound(compressor_.get(), member_.size()));
    compressed_.resize(libdeflate_deflate_compress(
        compressor_.get(), member_.data(), member_.size(), compressed_.data(), compressed_.size()));
    appendLittleEndian(libdeflate_crc32(0, member_.data(), member_.size()), compressed_);
    appendLittleEndian(static_cast<std::uint32_t>(member_.size()), compressed_);
    member_.clear();
    copyMember(compressed_);
}

void GzOutput::copyMember(const std::vector<std::uint8_t>& body)
{
    flush();
    // The header of the next one, too: until that comes, or the end, the file is not complete.
    file_.write(body.data(), body.size());
    file_.write(kHeader.data(), kHeader.size());
}

void GzOutput::commit()
{
    flush();
    file_.write(kEmptyBody.data(), kEmptyBody.size());
    file_.write(kEmptyMember.data(), kEmptyMember.size());
    file_.commit();
}
}  // namespace pointplane
