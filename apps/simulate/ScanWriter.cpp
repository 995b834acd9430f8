// SPDX-License-Identifier: BSD-3-Clause
#include "ScanWriter.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

void setCameras(CObservation3DRangeScan& scan, const PinholeCamera& camera)
{
    auto& intensity = scan.cameraParamsIntensity;
    intensity.ncols = static_cast<std::uint32_t>(camera.width);
    intensity.nrows = static_cast<std::uint32_t>(camera.height);
    intensity.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
    scan.cameraParams = intensity;
    scan.relativePoseIntensityWRTDepth = toMrpt(opticalInBody());
}

void setDepth(CObservation3DRangeScan& scan, const cv::Mat& depth)
{
    constexpr double kLargest = 65535;
    scan.hasRangeImage = true;
    scan.range_is_depth = true;
    scan.rangeUnits = static_cast<float>(1 / ScanWriter::kUnitsPerMetre);
    scan.maxRange = 10.0F;
    scan.rangeImage_setSize(depth.rows, depth.cols);
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* row = depth.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            // No reading (NaN), or farther than 16 bits reach.
            const double units = static_cast<double>(row[u]) * ScanWriter::kUnitsPerMetre;
            scan.rangeImage(v, u) = units > 0 && units <= kLargest
                                        ? static_cast<std::uint16_t>(std::lround(units))
                                        : std::uint16_t{0};
        }
    }
}
}  // namespace

ScanWriter::ScanWriter(const std::string& path, std::string label, bool external)
    : writer_(path), label_(std::move(label))
{
    if (external)
    {
        imagesDirectory_ = fs::path(path).replace_extension().string() + "_Images";
        std::error_code error;
        fs::create_directories(imagesDirectory_, error);
        if (error)
        {
            throw EnvironmentError("cannot create " + imagesDirectory_ + ": " + error.message());
        }
    }
}

void ScanWriter::writeComment(double stamp, const std::string& text)
{
    mrpt::obs::CObservationComment comment;
    comment.timestamp = fromSeconds(stamp);
    comment.text = text;
    writer_.write(comment);
}

void ScanWriter::write(const RgbdFrame& frame, const cv::Mat& colour)
{
    CObservation3DRangeScan scan;
    scan.sensorLabel = label_;
    scan.timestamp = fromSeconds(frame.stamp);
    setCameras(scan, frame.camera);
    setDepth(scan, frame.depth);
    scan.hasIntensityImage = true;
    scan.intensityImageChannel = CObservation3DRangeScan::CH_VISIBLE;
    if (imagesDirectory_.empty())
    {
        scan.intensityImage = mrpt::img::CImage(colour, mrpt::img::DEEP_COPY);
    }
    else
    {
        const std::string stamp = stampText(scan.timestamp);
        const std::string picture = stamp + "_rgb.png";
        const std::string path = imagesDirectory_ + "/" + picture;
        if (!cv::imwrite(path, colour, {cv::IMWRITE_PNG_COMPRESSION, 1}))
        {
            throw EnvironmentError("cannot write " + path);
        }
        scan.intensityImage.setExternalStorage(picture);
        moveRangeToFile(scan, imagesDirectory_, stamp + "_depth.bin");
    }
    writer_.write(scan);
}
}  // namespace pointplane
