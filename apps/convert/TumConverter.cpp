// SPDX-License-Identifier: BSD-3-Clause
#include "TumConverter.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "OutputGuard.h"
#include "ProgressBar.h"
#include "TextOutput.h"
#include "TumFolder.h"
#include "tum_camera.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Delays this close are not told anew [s]. */
constexpr double kSameDelay = 1e-4;

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

[[nodiscard]] RegisteredScan readScan(
    const TumImage& colour, const TumImage& depth, const TumCamera& camera)
{
    RegisteredScan scan;
    scan.stamp = colour.stamp;
    scan.camera = camera.camera;
    scan.unitsPerMetre = camera.unitsPerMetre;
    scan.depth = readImage(depth.path, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
    if (scan.depth.type() != CV_16UC1)
    {
        throw InputError(depth.path + ": is not a 16 bit depth image");
    }
    requireSize(scan.depth, camera.camera, depth.path);
    scan.colour = readImage(colour.path, cv::IMREAD_COLOR);
    requireSize(scan.colour, camera.camera, colour.path);
    scan.colourFile = colour.path;
    return scan;
}

[[nodiscard]] OutputGuard guardOf(
    const TumConverterOptions& options,
    const std::vector<TumImage>& colour,
    const std::vector<TumImage>& depth)
{
    OutputGuard guard;
    guard.addOutput("-o", options.output);
    guard.addOutput("ground truth of -o", groundTruthOf(options.output));
    if (options.external)
    {
        guard.addOutputFolder("images of -o", imagesFolderOf(options.output), "");
    }
    guard.addInput(options.camera);
    for (const char* name : {"rgb.txt", "depth.txt", "camera.txt", "groundtruth.txt"})
    {
        guard.addInput(options.folder + "/" + name);
    }
    for (const auto* images : {&colour, &depth})
    {
        for (const TumImage& image : *images)
        {
            guard.addInput(image.path);
        }
    }
    return guard;
}

/** \return where to, or empty if there is none */
[[nodiscard]] std::string copyGroundTruth(const TumConverterOptions& options)
{
    const std::string from = options.folder + "/groundtruth.txt";
    if (!fs::exists(from))
    {
        return "";
    }
    const std::string to = groundTruthOf(options.output);
    std::ifstream in(from, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    if (!in)
    {
        throw InputError("cannot read " + from);
    }
    TextOutput out(to);
    out.write(text);
    out.close();
    return to;
}
struct Recording
{
    const TumConverterOptions& options;
    const std::vector<TumImage>& colour;
    const std::vector<TumImage>& depth;
    const std::vector<std::pair<std::size_t, std::size_t>>& pairs;
    TumCamera camera;
};

void writeFrames(Recording recording, ScanWriter& writer, std::ostream& progress)
{
    const auto& [options, colour, depth, pairs, camera] = recording;
    ShutterModel& shutter = recording.camera.shutter;
    std::optional<ProgressBar> bar;
    if (!options.quiet)
    {
        bar.emplace(progress, standardErrorIsTerminal(), options.folder);
    }
    std::size_t numFrames = 0;
    for (const auto& [c, d] : pairs)
    {
        // Some colour images go with the depth image before, some with that after: 33 ms apart.
        const double delay = depth[d].seconds - colour[c].seconds;
        if (numFrames == 0 || std::abs(delay - shutter.depthDelay) > kSameDelay)
        {
            shutter.depthDelay = delay;
            writer.writeComment(colour[c].stamp, shutterComment(options.label, shutter));
        }
        writer.write(readScan(colour[c], depth[d], camera));
        ++numFrames;
        if (bar)
        {
            bar->update(
                static_cast<double>(numFrames) / static_cast<double>(pairs.size()), numFrames);
        }
    }
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
    if (options.depthScale > 0)
    {
        camera.unitsPerMetre = options.depthScale;
    }
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

    (void)guardOf(options, colour, depth);
    ScanWriter writer(options.output, options.label, options.external);
    TumConversion out;
    try
    {
        writeFrames({options, colour, depth, pairs, camera}, writer, progress);
        out.groundTruth = copyGroundTruth(options);
    }
    catch (const InputError&)
    {
        writer.discard();
        throw;
    }
    writer.close();
    out.numFrames = pairs.size();
    out.numColourAlone = colour.size() - pairs.size();
    out.numDepthAlone = depth.size() - pairs.size();
    out.depthDelay = median(delays);
    return out;
}
}  // namespace pointplane
