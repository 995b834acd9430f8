// SPDX-License-Identifier: BSD-3-Clause
// How fuzz inputs describe frames: a record of plain numbers, its pixels, the next record.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <cstring>

namespace pointplane::fuzzing
{
constexpr double kDepthStep = 2e-4;  //!< [m] of depth given as whole numbers, as in TUM's images

/** A frame for Odometry. Pixels that follow: gray, then depth. */
struct FrameRecord
{
    enum Flag : std::uint8_t
    {
        HasGray = 1,
        DepthIsFloat = 2,  //!< any bits of a float [m]; otherwise 16 bit in steps of kDepthStep
        GrayOfAnotherSize = 4,
        DepthOfAnotherSize = 8,
        HasShutter = 32
    };
    double stamp;
    double fx, fy, cx, cy;
    double distortion[5];
    double shutter[3];
    std::uint8_t width, height, flags, spare[5];
};

/** A camera as MRPT writes it down. */
struct CameraRecord
{
    double fx, fy, cx, cy;
    double distortion[8];
    std::uint8_t model, width, height, spare[5];
};

/** An observation for VisualOdometry. Pixels that follow: intensity, then 16-bit ranges. */
struct ScanRecord
{
    enum Flag : std::uint8_t
    {
        HasIntensity = 1,
        HasRange = 2,
        IsColour = 4,
        RangesAlongRays = 8,
    };
    std::int64_t stamp_100ns;
    CameraRecord depthCamera, intensityCamera;
    double intensityPose[6], sensorPose[6];  //!< x y z yaw pitch roll
    float rangeUnits;
    std::uint8_t rangeWidth, rangeHeight, intensityWidth, intensityHeight, flags, spare[7];
};

/** The bytes of an input, in order; zeros when there are no more. */
class ByteSource
{
 public:
    ByteSource(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

    [[nodiscard]] bool isEmpty() const { return next_ == end_; }

    template <class T>
    [[nodiscard]] T take()
    {
        T value;
        std::memset(static_cast<void*>(&value), 0, sizeof(T));
        copy(&value, sizeof(T));
        return value;
    }

    [[nodiscard]] cv::Mat takeImage(int rows, int cols, int type)
    {
        cv::Mat image = cv::Mat::zeros(rows, cols, type);
        copy(image.data, image.total() * image.elemSize());
        return image;
    }

 private:
    void copy(void* target, std::size_t size)
    {
        const auto left = static_cast<std::size_t>(end_ - next_);
        const std::size_t n = size < left ? size : left;
        if (n > 0)
        {
            std::memcpy(target, next_, n);
        }
        next_ += n;
    }

    const std::uint8_t* next_;
    const std::uint8_t* end_;
};
}  // namespace pointplane::fuzzing
