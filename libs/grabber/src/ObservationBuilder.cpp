// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/ObservationBuilder.h>

#include <opencv2/imgproc.hpp>

#include <cstring>

namespace pointplane
{
cv::Mat toBgr(const CameraImage& colour)
{
    cv::Mat bgr;
    switch (colour.layout)
    {
        case PixelLayout::Rgb8:
            cv::cvtColor(colour.pixels, bgr, cv::COLOR_RGB2BGR);
            break;
        case PixelLayout::Yuyv:
            cv::cvtColor(colour.pixels, bgr, cv::COLOR_YUV2BGR_YUYV);
            break;
        case PixelLayout::Uyvy:
            cv::cvtColor(colour.pixels, bgr, cv::COLOR_YUV2BGR_UYVY);
            break;
        default:
            bgr = colour.pixels;
            break;
    }
    return bgr;
}

void ObservationBuilder::fill(
    const ImagePair& pair, mrpt::obs::CObservation3DRangeScan& observation) const
{
    const cv::Mat& depth = pair.depth.pixels;
    observation.timestamp = mrpt::Clock::fromDouble(pair.stamp);
    observation.sensorLabel = calibration_.sensorLabel;
    observation.sensorPose = calibration_.sensorPose;
    observation.cameraParams = calibration_.depth;
    observation.cameraParamsIntensity = calibration_.colour;
    observation.relativePoseIntensityWRTDepth = calibration_.colourWrtDepth;
    observation.maxRange = 10.0F;
    observation.range_is_depth = true;
    observation.rangeUnits = static_cast<float>(pair.depth.depthUnit);

    observation.hasRangeImage = true;
    observation.rangeImage.resize(depth.rows, depth.cols);
    for (int row = 0; row < depth.rows; ++row)
    {
        std::memcpy(
            &observation.rangeImage(row, 0),
            depth.ptr(row),
            static_cast<std::size_t>(depth.cols) * sizeof(std::uint16_t));
    }
    observation.hasIntensityImage = !pair.colour.pixels.empty();
    if (observation.hasIntensityImage)
    {
        observation.intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
        observation.intensityImage = mrpt::img::CImage(toBgr(pair.colour), mrpt::img::SHALLOW_COPY);
    }
}
}  // namespace pointplane
