// SPDX-License-Identifier: BSD-3-Clause
#include "TumConverter.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "ProgressBar.h"
#include "TumFolder.h"
#include "tum_camera.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

[[nodiscard]] std::vector<double> secondsOf(const std::vector<TumImage>& images)
{
    std::vector<double> out;
    std::transform(
        images.begin(),
        images.end(),
        std::back_inserter(out),
        [](const TumImage& image) { return image.seconds; });
    return out;
}

[[nodiscard]] double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/** "dir/name" of "dir/name.rawlog". */
[[nodiscard]] std::string stem(const std::string& rawlog)
{
    return (fs::path(rawlog).parent_path() / fs::path(rawlog).stem()).string();
}

[[nodiscard]] cv::Mat readImage(const std::string& path, int flags)
{
    if (!fs::is_regular_file(path))
    {
        throw InputError("cannot open " + path + ": no such file");
    }
    cv::Mat image = cv::imread(path, flags);
    if (image.empty())
    {
        throw InputError(path + ": is not an image, or damaged");
    }
    return image;
}

void requireSize(const cv::Mat& image, const PinholeCamera& camera, const std::string& path)
{
    if (image.cols != camera.width || image.rows != camera.height)
    {
        throw InputError(
            path + ": is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
            " but the camera is for " + std::to_string(camera.width) + "x" +
            std::to_string(camera.height));
    }
}

/** Builds the observations of one folder. */
class ScanBuilder
{
 public:
    ScanBuilder(const TumConverterOptions& options, const TumCamera& camera)
        : options_(options), camera_(camera)
    {
        if (options.external)
        {
            imagesDirectory_ = stem(options.output) + "_Images";
            std::error_code error;
            fs::create_directories(imagesDirectory_, error);
            if (error)
            {
                throw EnvironmentError(
                    "cannot create " + imagesDirectory_ + ": " + error.message());
            }
        }
    }

    [[nodiscard]] CObservation3DRangeScan::Ptr build(
        const TumImage& colour, const TumImage& depth) const
    {
        auto scan = CObservation3DRangeScan::Create();
        scan->sensorLabel = options_.label;
        scan->timestamp = colour.stamp;
        scan->maxRange = 10.0F;
        setCameras(*scan);
        setDepth(*scan, depth);
        setColour(*scan, colour);
        return scan;
    }

 private:
    void setCameras(CObservation3DRangeScan& scan) const
    {
        const PinholeCamera& camera = camera_.camera;
        auto& intensity = scan.cameraParamsIntensity;
        intensity.ncols = static_cast<std::uint32_t>(camera.width);
        intensity.nrows = static_cast<std::uint32_t>(camera.height);
        intensity.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
        // Registered depth knows the ideal pinhole only.
        scan.cameraParams = intensity;
        if (camera.isDistorted())
        {
            intensity.distortion = mrpt::img::DistortionModel::plumb_bob;
            std::copy(camera.distortion.begin(), camera.distortion.end(), intensity.dist.begin());
        }
        scan.relativePoseIntensityWRTDepth = toMrpt(opticalInBody());
    }

    void setDepth(CObservation3DRangeScan& scan, const TumImage& image) const
    {
        const cv::Mat depth = readImage(image.path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
        if (depth.type() != CV_16UC1)
        {
            throw InputError(image.path + ": is not a 16 bit depth image");
        }
        requireSize(depth, camera_.camera, image.path);
        const double scale = options_.depthScale > 0 ? options_.depthScale : camera_.unitsPerMetre;
        scan.hasRangeImage = true;
        scan.rangeUnits = static_cast<float>(1.0 / scale);
        scan.rangeImage_setSize(depth.rows, depth.cols);
        for (int v = 0; v < depth.rows; ++v)
        {
            std::memcpy(
                &scan.rangeImage(v, 0),
                depth.ptr<std::uint16_t>(v),
                static_cast<std::size_t>(depth.cols) * sizeof(std::uint16_t));
        }
        if (options_.external)
        {
            moveRangeToFile(scan, imagesDirectory_, stampText(scan.timestamp) + "_depth.bin");
        }
    }

    void setColour(CObservation3DRangeScan& scan, const TumImage& image) const
    {
        const cv::Mat colour = readImage(image.path, cv::IMREAD_COLOR);
        requireSize(colour, camera_.camera, image.path);
        scan.hasIntensityImage = true;
        scan.intensityImageChannel = CObservation3DRangeScan::CH_VISIBLE;
        if (!options_.external)
        {
            scan.intensityImage = mrpt::img::CImage(colour, mrpt::img::DEEP_COPY);
            return;
        }
        const std::string name =
            stampText(scan.timestamp) + "_rgb" + fs::path(image.path).extension().string();
        std::error_code error;
        fs::copy_file(
            image.path,
            fs::path(imagesDirectory_) / name,
            fs::copy_options::overwrite_existing,
            error);
        if (error)
        {
            throw EnvironmentError(
                "cannot write " + imagesDirectory_ + "/" + name + ": " + error.message());
        }
        scan.intensityImage.setExternalStorage(name);
    }

    const TumConverterOptions& options_;
    const TumCamera& camera_;
    std::string imagesDirectory_;
};

/** \return where to, or empty if there is none */
[[nodiscard]] std::string copyGroundTruth(const TumConverterOptions& options)
{
    const std::string from = options.folder + "/groundtruth.txt";
    if (!fs::exists(from))
    {
        return "";
    }
    const std::string to = stem(options.output) + ".groundtruth.txt";
    // Not copy_file: it would copy a write protection, too.
    std::ifstream in(from, std::ios::binary);
    std::ofstream out(to, std::ios::binary);
    out << in.rdbuf();
    out.close();
    if (!in || !out)
    {
        throw EnvironmentError("cannot copy " + from + " to " + to);
    }
    return to;
}
}  // namespace

TumConversion convertTum(const TumConverterOptions& options, std::ostream& progress)
{
    if (!fs::is_directory(options.folder))
    {
        throw InputError(options.folder + ": is not a folder");
    }
    const std::vector<TumImage> colour = readTumListing(options.folder, "rgb.txt");
    const std::vector<TumImage> depth = readTumListing(options.folder, "depth.txt");
    TumCamera camera = loadTumCamera(options.camera, options.folder);
    const auto pairs = associate(secondsOf(colour), secondsOf(depth), 0.0, options.maxDifference);
    if (pairs.empty())
    {
        throw InputError(
            options.folder + ": no colour and depth stamps within " +
            std::to_string(options.maxDifference) + " s of each other");
    }
    std::vector<double> delays;
    for (const auto& [c, d] : pairs)
    {
        delays.push_back(depth[d].seconds - colour[c].seconds);
    }
    camera.shutter.depthDelay = median(delays);

    RawlogWriter writer(options.output);
    mrpt::obs::CObservationComment comment;
    comment.timestamp = colour[pairs.front().first].stamp;
    comment.text = shutterComment(options.label, camera.shutter);
    writer.write(comment);
    const ScanBuilder builder(options, camera);
    std::optional<ProgressBar> bar;
    if (!options.quiet)
    {
        bar.emplace(progress, standardErrorIsTerminal(), options.folder);
    }
    TumConversion out;
    for (const auto& [c, d] : pairs)
    {
        writer.write(*builder.build(colour[c], depth[d]));
        ++out.numFrames;
        if (bar)
        {
            bar->update(
                static_cast<double>(out.numFrames) / static_cast<double>(pairs.size()),
                out.numFrames);
        }
    }
    out.groundTruth = copyGroundTruth(options);
    writer.close();
    out.numColourAlone = colour.size() - pairs.size();
    out.numDepthAlone = depth.size() - pairs.size();
    out.depthDelay = camera.shutter.depthDelay;
    return out;
}
}  // namespace pointplane
