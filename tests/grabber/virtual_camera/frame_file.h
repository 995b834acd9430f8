// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pointplane::test
{
/** Uncompressed RGB-D frames: what the virtual camera plays. Header, then per frame depth (uint16,
 * millimetres) and colour (RGB). */
struct FrameFileHeader
{
    char magic[8]{'P', 'P', 'F', 'R', 'A', 'M', 'E', 'S'};
    std::int32_t width{0}, height{0}, numFrames{0};
    double focal_px{0};
};

class FrameFile
{
 public:
    /** Empty path: one 64 x 48 frame of zeros. */
    explicit FrameFile(const std::string& path)
    {
        if (path.empty())
        {
            header_.width = 64;
            header_.height = 48;
            header_.numFrames = 1;
            header_.focal_px = 52.5;
            data_.resize(frameBytes());
            return;
        }
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(&header_), sizeof(header_));
        if (!file ||
            std::memcmp(header_.magic, FrameFileHeader{}.magic, sizeof(header_.magic)) != 0)
        {
            throw std::runtime_error("not a frame file: " + path);
        }
        data_.resize(frameBytes() * static_cast<std::size_t>(header_.numFrames));
        file.read(data_.data(), static_cast<std::streamsize>(data_.size()));
    }

    [[nodiscard]] int width() const { return header_.width; }
    [[nodiscard]] int height() const { return header_.height; }
    [[nodiscard]] int numFrames() const { return header_.numFrames; }
    [[nodiscard]] double focal_px() const { return header_.focal_px; }
    [[nodiscard]] const void* depth(int n) const
    {
        return data_.data() + frameBytes() * static_cast<std::size_t>(n);
    }
    [[nodiscard]] const void* colour(int n) const
    {
        return data_.data() + frameBytes() * static_cast<std::size_t>(n) + numPixels() * 2;
    }

 private:
    [[nodiscard]] std::size_t numPixels() const
    {
        return static_cast<std::size_t>(header_.width) * static_cast<std::size_t>(header_.height);
    }
    [[nodiscard]] std::size_t frameBytes() const { return numPixels() * 5; }

    FrameFileHeader header_;
    std::vector<char> data_;
};
}  // namespace pointplane::test
