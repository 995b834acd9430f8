// SPDX-License-Identifier: BSD-3-Clause
#include "sequences.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>

#include "TumFolder.h"
#include "tum_camera.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

struct TumPair
{
    TumImage colour, depth;
};

[[nodiscard]] std::vector<TumPair> pairsOf(const std::string& folder)
{
    const auto colour = readTumListing(folder, "rgb.txt");
    const auto depth = readTumListing(folder, "depth.txt");
    std::vector<double> a, b;
    std::for_each(colour.begin(), colour.end(), [&](const auto& c) { a.push_back(c.seconds); });
    std::for_each(depth.begin(), depth.end(), [&](const auto& d) { b.push_back(d.seconds); });
    std::vector<TumPair> out;
    for (const auto& [c, d] : associate(a, b, 0.0, 0.02))
    {
        out.push_back({colour[c], depth[d]});
    }
    if (out.empty())
    {
        throw InputError(folder + ": no colour and depth stamps within 0.02 s of each other");
    }
    return out;
}

[[nodiscard]] double medianDelay(const std::vector<TumPair>& pairs)
{
    std::vector<double> delays;
    for (const TumPair& pair : pairs)
    {
        delays.push_back(pair.depth.seconds - pair.colour.seconds);
    }
    const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
    std::nth_element(delays.begin(), middle, delays.end());
    return *middle;
}

[[nodiscard]] RgbdFrame readFrame(const TumPair& pair, const TumCamera& camera)
{
    RgbdFrame out;
    out.stamp = pair.colour.seconds;
    out.camera = camera.camera;
    out.shutter = camera.shutter;
    out.gray = cv::imread(pair.colour.path, cv::IMREAD_GRAYSCALE);
    const cv::Mat raw = cv::imread(pair.depth.path, cv::IMREAD_UNCHANGED);
    if (out.gray.empty() || raw.type() != CV_16UC1 || raw.size() != out.gray.size())
    {
        throw InputError(pair.depth.path + ": not a 16 bit depth image with a colour image");
    }
    raw.convertTo(out.depth, CV_32F, 1.0 / camera.unitsPerMetre);
    out.depth.setTo(std::numeric_limits<float>::quiet_NaN(), raw == 0);
    return out;
}

[[nodiscard]] BenchmarkSequence tumSequence(const std::string& folder)
{
    TumCamera camera = loadTumCamera("", folder);
    const auto pairs = pairsOf(folder);
    camera.shutter = {};
    camera.shutter.depthDelay = medianDelay(pairs);
    BenchmarkSequence out;
    out.name = fs::path(folder).filename().string();
    out.numFrames = pairs.size();
    out.frame = [pairs, camera](std::size_t k) { return readFrame(pairs.at(k), camera); };
    out.truth = readTrajectoryText(folder + "/groundtruth.txt");
    return out;
}

[[nodiscard]] BenchmarkSequence simulatedSequence(
    const std::shared_ptr<const SimulatedSequence>& simulation, std::string name, bool hide)
{
    BenchmarkSequence out;
    out.name = std::move(name);
    out.numFrames = static_cast<std::size_t>(simulation->numFrames());
    out.frame = [simulation, hide](std::size_t k)
    {
        RgbdFrame frame = simulation->frame(static_cast<int>(k));
        if (hide)
        {
            frame.shutter = {};
        }
        return frame;
    };
    out.truth.name = out.name;
    for (int k = 0; k < simulation->numFrames(); ++k)
    {
        out.truth.stamps.push_back(simulation->stamp(k));
        out.truth.poses.push_back(simulation->truth(simulation->stamp(k)));
    }
    return out;
}
}  // namespace

std::vector<BenchmarkSequence> tumSequences(const std::string& data)
{
    std::vector<std::string> folders;
    for (const auto& entry : fs::directory_iterator(data))
    {
        if (fs::exists(entry.path() / "rgb.txt") && fs::exists(entry.path() / "groundtruth.txt"))
        {
            folders.push_back(entry.path().string());
        }
    }
    std::sort(folders.begin(), folders.end());
    std::vector<BenchmarkSequence> out;
    std::transform(folders.begin(), folders.end(), std::back_inserter(out), tumSequence);
    return out;
}

std::vector<BenchmarkSequence> simulatedSequences(double duration)
{
    constexpr std::uint64_t kSeed = 1;
    SimulationParams params;
    params.duration = duration;
    std::vector<BenchmarkSequence> out;
    for (const char* scene : {"corner", "desk", "notexture", "cabinet", "corridor", "room"})
    {
        const auto simulation = std::make_shared<SimulatedSequence>(scene, params, kSeed);
        out.push_back(simulatedSequence(simulation, std::string("sim ") + scene, false));
        out.push_back(
            simulatedSequence(simulation, std::string("sim ") + scene + " (hidden shutter)", true));
    }
    return out;
}
}  // namespace pointplane
