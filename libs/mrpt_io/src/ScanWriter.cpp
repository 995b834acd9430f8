// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/ImagesFolder.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

constexpr float kMaxRange = 10.0F;  // [m] where viewers clip

[[nodiscard]] mrpt::img::TCamera withoutDistortion(const PinholeCamera& camera)
{
    mrpt::img::TCamera out;
    out.ncols = static_cast<std::uint32_t>(camera.width);
    out.nrows = static_cast<std::uint32_t>(camera.height);
    out.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
    return out;
}

[[nodiscard]] mrpt::img::TCamera withDistortion(const PinholeCamera& camera)
{
    mrpt::img::TCamera out = withoutDistortion(camera);
    if (camera.isDistorted())
    {
        out.distortion = mrpt::img::DistortionModel::plumb_bob;
        std::copy(camera.distortion.begin(), camera.distortion.end(), out.dist.begin());
    }
    return out;
}

void setCameras(CObservation3DRangeScan& out, const RegisteredScan& scan)
{
    out.cameraParamsIntensity = withDistortion(scan.camera);
    // Registered depth knows the ideal pinhole only.
    out.cameraParams = scan.depthCamera ? withDistortion(scan.depthCamera->camera)
                                        : withoutDistortion(scan.camera);
    const Eigen::Isometry3d T_depth_colour =
        scan.depthCamera ? scan.depthCamera->T_depth_colour : Eigen::Isometry3d::Identity();
    out.relativePoseIntensityWRTDepth = toMrpt(opticalInBody() * T_depth_colour);
}

void setDepth(CObservation3DRangeScan& out, const RegisteredScan& scan)
{
    out.hasRangeImage = true;
    out.range_is_depth = true;
    out.rangeUnits = static_cast<float>(1 / scan.unitsPerMetre);
    out.maxRange = kMaxRange;
    out.rangeImage_setSize(scan.depth.rows, scan.depth.cols);
    for (int v = 0; v < scan.depth.rows; ++v)
    {
        std::memcpy(
            &out.rangeImage(v, 0),
            scan.depth.ptr<std::uint16_t>(v),
            static_cast<std::size_t>(scan.depth.cols) * sizeof(std::uint16_t));
    }
}

/** Whether the name is one that is given here: a stamp, a number of frames that share it, and
 * `_rgb.png` or `_depth.bin`. */
[[nodiscard]] bool isImageName(const std::string& name)
{
    const std::size_t end = name.find_first_not_of("0123456789.-");
    return end != 0 && end != std::string::npos &&
           (name.compare(end, 5, "_rgb.") == 0 ||
            name.compare(end, std::string::npos, "_depth.bin") == 0);
}

/** The file's bytes where the image came from one, else a PNG. \return its name */
std::string writeColourFile(
    const RegisteredScan& scan, const std::string& folder, const std::string& beginning)
{
    const bool copied = !scan.colourFile.empty();
    const std::string name =
        beginning + "_rgb" + (copied ? fs::path(scan.colourFile).extension().string() : ".png");
    const std::string path = (fs::path(folder) / name).string();
    if (!copied)
    {
        writeImageFile(path, scan.colour, {cv::IMWRITE_PNG_COMPRESSION, 1});
        return name;
    }
    std::error_code error, ignored;
    if (fs::equivalent(scan.colourFile, path, ignored))
    {
        return name;  // it is there, and to remove it after a failure would be to lose it
    }
    fs::copy_file(scan.colourFile, path, fs::copy_options::overwrite_existing, error);
    if (error)
    {
        fs::remove(path, ignored);
        throw EnvironmentError("cannot write " + path + ": " + error.message());
    }
    return name;
}
}  // namespace

ScanWriter::ScanWriter(const std::string& path, std::string label, bool external)
    : writer_(path), label_(std::move(label))
{
    if (!external)
    {
        return;
    }
    try
    {
        // After the rawlog: who writes that has its images to himself.
        images_ = std::make_unique<ImagesFolder>(
            imagesFolderOf(path), OwnImages{"image of a rawlog", [](const fs::path& file) {
                                                return isImageName(file.filename().string());
                                            }});
    }
    catch (...)
    {
        writer_.discard();
        throw;
    }
}

ScanWriter::~ScanWriter() = default;

void ScanWriter::close()
{
    if (!images_)
    {
        writer_.close();
        return;
    }
    images_->completeWith([this] { writer_.close(); });
}

void ScanWriter::discard() noexcept
{
    writer_.discard();
    if (images_)
    {
        images_->removePartial();
    }
}

void ScanWriter::writeComment(mrpt::Clock::time_point stamp, const std::string& text)
{
    mrpt::obs::CObservationComment comment;
    comment.timestamp = stamp;
    comment.text = text;
    writer_.write(comment);
}

std::string ScanWriter::imageName(mrpt::Clock::time_point stamp)
{
    const std::string text = stampText(stamp);
    const int number = ++numOfStamp_[text];
    return number == 1 ? text : text + "-" + std::to_string(number);
}

void ScanWriter::write(const RegisteredScan& scan)
{
    const cv::Size size(scan.camera.width, scan.camera.height);
    const PinholeCamera& ofDepth = scan.depthCamera ? scan.depthCamera->camera : scan.camera;
    POINTPLANE_CHECK(scan.depth.type() == CV_16UC1, "depth is not CV_16UC1");
    POINTPLANE_CHECK(
        scan.colour.empty() || scan.colour.type() == CV_8UC3 || scan.colour.type() == CV_8UC1,
        "colour is neither CV_8UC3 nor CV_8UC1");
    POINTPLANE_CHECK(
        scan.depth.size() == cv::Size(ofDepth.width, ofDepth.height) &&
            (scan.colour.empty() || scan.colour.size() == size),
        "images do not fit the camera, " << size.width << "x" << size.height);
    const std::string units = problemOfDepthUnits(scan.unitsPerMetre);
    POINTPLANE_CHECK(units.empty(), "unitsPerMetre: " << units);
    CObservation3DRangeScan out;
    out.sensorLabel = label_;
    out.timestamp = scan.stamp;
    setCameras(out, scan);
    setDepth(out, scan);
    out.hasIntensityImage = !scan.colour.empty();
    out.intensityImageChannel = CObservation3DRangeScan::CH_VISIBLE;
    const std::string name = images_ ? imageName(scan.stamp) : "";
    if (out.hasIntensityImage && images_)
    {
        out.intensityImage.setExternalStorage(writeColourFile(scan, images_->partialPath(), name));
    }
    else if (out.hasIntensityImage)
    {
        out.intensityImage = mrpt::img::CImage(scan.colour, mrpt::img::DEEP_COPY);
    }
    if (images_)
    {
        moveRangeToFile(out, images_->partialPath(), name + "_depth.bin");
    }
    writer_.write(out);
}

std::string problemOfDepthUnits(double unitsPerMetre)
{
    if (unitsPerMetre >= kLeastDepthUnits && unitsPerMetre <= kMostDepthUnits)
    {
        return "";
    }
    std::ostringstream out = numberStream();
    out << unitsPerMetre << " is not a number from " << kLeastDepthUnits << " to "
        << kMostDepthUnits;
    return out.str();
}

cv::Mat depthInUnits(const cv::Mat& depth, double unitsPerMetre)
{
    cv::Mat out(depth.size(), CV_16UC1);
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* from = depth.ptr<float>(v);
        auto* to = out.ptr<std::uint16_t>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            const double units = static_cast<double>(from[u]) * unitsPerMetre;
            to[u] = units > 0 && units <= kSaturatedDepth - 1
                        ? static_cast<std::uint16_t>(std::lround(units))
                        : std::uint16_t{0};
        }
    }
    return out;
}
}  // namespace pointplane
