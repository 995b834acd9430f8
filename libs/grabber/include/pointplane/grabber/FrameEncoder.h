// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/ObservationBuilder.h>

#include <cstdint>
#include <string>
#include <vector>

struct libdeflate_compressor;

namespace pointplane
{
enum class ImageStorage
{
    Embedded,  //!< in the rawlog
    External   //!< PNG or JPEG and .bin files in NAME_Images, as `rawlog-edit --externalize` does
};

struct EncodingOptions
{
    ImageStorage storage{ImageStorage::Embedded};
    int compression{1};  //!< 0 none, 1 fastest ... 9 smallest; always lossless
    int jpegQuality{0};  //!< 1 to 100 of the colour images; 0 = lossless
};

/** Serialises observations, one complete gz member (or plain object) each: members can be made in
 * parallel, and every prefix of whole members is a valid rawlog. One encoder per thread. */
class FrameEncoder
{
 public:
    /** Sets MRPT's process-wide JPEG settings, which embedded images obey. */
    FrameEncoder(const EncodingOptions& options, const ObservationBuilder& builder);
    ~FrameEncoder();
    FrameEncoder(const FrameEncoder&) = delete;
    FrameEncoder& operator=(const FrameEncoder&) = delete;

    /** \param imagesFolder where external images go (existing), unused for embedded ones
     * \param[out] externalBytes size of the external files
     * \param comments put first
     * \return what to append to the rawlog \throws EnvironmentError if a file cannot be written */
    [[nodiscard]] std::vector<std::uint8_t> encode(
        const ImagePair& pair,
        const std::string& imagesFolder,
        std::uint64_t& externalBytes,
        const std::vector<std::string>& comments = {});

    /** A comment alone. \param stamp [s] UTC */
    [[nodiscard]] std::vector<std::uint8_t> encode(const std::string& comment, double stamp);

 private:
    [[nodiscard]] std::vector<std::uint8_t> compressed(const void* data, std::size_t size) const;

    EncodingOptions options_;
    const ObservationBuilder& builder_;
    libdeflate_compressor* compressor_{nullptr};
};
}  // namespace pointplane
