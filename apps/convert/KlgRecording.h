// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "Recording.h"
#include "calibration_file.h"

namespace pointplane
{
struct KlgOptions
{
    std::string file;
    std::string camera;    //!< file; empty: nominal
    double depthScale{0};  //!< units per metre; 0: the camera's, or millimetres
    bool bgr{false};       //!< colours of the log are blue, green, red
};

/** A log of Kintinuous or ElasticFusion: an int32 with the number of frames; each frame an int64
 * with its time [us], int32 sizes of depth and colour, depth (16 bit, plain or zlib) and colour
 * (8 bit RGB, plain or JPEG). Little endian. Written by Logger2, which tells the number in the end
 * and 0 until then; read by its RawLogReader. */
class KlgRecording : public Recording
{
 public:
    /** \throws InputError */
    explicit KlgRecording(const KlgOptions& options);

    [[nodiscard]] std::optional<RecordedFrame> next() override;
    [[nodiscard]] double progress() const override;
    [[nodiscard]] std::string damage() const override { return damage_; }
    [[nodiscard]] std::vector<std::string> notes() const override;

 private:
    struct FrameHead
    {
        std::int64_t microseconds{0};
        std::int32_t depthSize{0}, colourSize{0};
    };

    void checkUnitOfStamps();
    [[nodiscard]] bool read(FrameHead& head);
    template <class T>
    [[nodiscard]] bool read(T& value);
    [[nodiscard]] bool read(std::vector<unsigned char>& bytes, std::int32_t size);
    [[nodiscard]] bool isAtEnd();
    [[nodiscard]] std::optional<RecordedFrame> stopped();
    [[nodiscard]] std::optional<RecordedFrame> ended();
    [[nodiscard]] cv::Mat depthOf(const std::vector<unsigned char>& bytes) const;
    [[nodiscard]] cv::Mat colourOf(const std::vector<unsigned char>& bytes) const;
    [[nodiscard]] std::string where() const;

    KlgOptions options_;
    Calibration camera_;
    bool isNominal_{false}, isUnclosed_{false};
    std::ifstream file_;
    std::uint64_t fileSize_{0};
    std::int32_t numFrames_{0}, next_{0};
    std::string damage_;
};
}  // namespace pointplane
