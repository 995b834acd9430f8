// SPDX-License-Identifier: BSD-3-Clause
#include "sequences.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "TumFolder.h"
#include "calibration_file.h"

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

[[nodiscard]] RgbdFrame readFrame(const TumPair& pair, const Calibration& camera)
{
    RgbdFrame out;
    out.stamp = pair.colour.seconds;
    out.camera = camera.camera;
    out.shutter.depthDelay = pair.depth.seconds - pair.colour.seconds;
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

/** Noise of the motion capture of the TUM sequences, per pose; of the rotation about the camera's
 * x, y, z as benchmark_ground_truth finds it on fr1 and fr3, averaged. */
constexpr double kMotionCaptureSigma = 1e-4;  // [m]
constexpr double kMotionCaptureSigmaDeg[] = {0.12, 0.06, 0.055};

[[nodiscard]] bool startsWith(const std::string& text, const std::string& start)
{
    return text.compare(0, start.size(), start) == 0;
}

[[nodiscard]] BenchmarkSequence tumSequence(const std::string& folder)
{
    const Calibration camera = loadCalibration("", folder);
    const auto pairs = pairsOf(folder);
    BenchmarkSequence out;
    out.name = fs::path(folder).filename().string();
    out.numFrames = pairs.size();
    out.frame = [pairs, camera](std::size_t k) { return readFrame(pairs.at(k), camera); };
    if (!fs::exists(folder + "/groundtruth.txt"))
    {
        out.kind = Truth::None;
        return out;
    }
    out.truth = readTrajectoryText(folder + "/groundtruth.txt");
    out.kind = startsWith(out.name, "iphone_") ? Truth::Loose : Truth::Exact;
    if (startsWith(out.name, "tum_") || startsWith(out.name, "rgbd_dataset_"))
    {
        out.nees.truthSigmaTranslation = kMotionCaptureSigma;
        out.nees.truthSigmaRotation =
            Eigen::Map<const Eigen::Vector3d>(kMotionCaptureSigmaDeg) * M_PI / 180;
    }
    return out;
}

[[nodiscard]] BenchmarkSequence simulatedSequence(
    const std::string& name, const std::string& scene, const SimulationParams& params)
{
    constexpr std::uint64_t kSeed = 1;
    const auto simulation = std::make_shared<SimulatedSequence>(scene, params, kSeed);
    BenchmarkSequence out;
    out.name = name;
    out.numFrames = static_cast<std::size_t>(simulation->numFrames());
    out.frame = [simulation](std::size_t k) { return simulation->frame(static_cast<int>(k)); };
    out.truth.name = out.name;
    for (int k = 0; k < simulation->numFrames(); ++k)
    {
        out.truth.stamps.push_back(simulation->stamp(k));
        out.truth.poses.push_back(simulation->truth(simulation->stamp(k)));
    }
    return out;
}

/** Folders that hold all of the files, in order of name. */
[[nodiscard]] std::vector<SequenceSource> foldersWith(
    const std::string& data, const std::vector<std::string>& files)
{
    if (!fs::is_directory(data))
    {
        throw InputError(data + ": no such folder");
    }
    std::vector<std::string> folders;
    for (const auto& entry : fs::directory_iterator(data))
    {
        const auto holds = [&entry](const std::string& file)
        { return fs::exists(entry.path() / file); };
        if (std::all_of(files.begin(), files.end(), holds))
        {
            folders.push_back(entry.path().string());
        }
    }
    std::sort(folders.begin(), folders.end());
    std::vector<SequenceSource> out;
    for (const std::string& folder : folders)
    {
        out.push_back(
            {fs::path(folder).filename().string(), [folder] { return tumSequence(folder); }});
    }
    return out;
}
}  // namespace

std::vector<SequenceSource> tumSequences(const std::string& data)
{
    return foldersWith(data, {"rgb.txt", "groundtruth.txt"});
}

std::vector<SequenceSource> recordedSequences(const std::string& data)
{
    return foldersWith(data, {"rgb.txt", "depth.txt"});
}

std::vector<SequenceSource> simulatedSequences(double duration)
{
    std::vector<SequenceSource> out;
    for (const std::string scene : {"corner", "desk", "notexture", "cabinet", "corridor"})
    {
        SimulationParams params;
        params.duration = duration;
        const std::string name = "simulated " + scene;
        out.push_back(
            {name, [name, scene, params] { return simulatedSequence(name, scene, params); }});
    }
    return out;
}

std::vector<SequenceSource> hardSimulatedSequences(double duration)
{
    std::vector<SequenceSource> out;
    const auto add =
        [&out](const std::string& scene, const std::string& what, const SimulationParams& params)
    {
        const std::string name = "simulated " + scene + what;
        out.push_back(
            {name,
             [name, scene, params]
             {
                 BenchmarkSequence hard = simulatedSequence(name, scene, params);
                 hard.isHardAlready = true;
                 return hard;
             }});
    };
    SimulationParams usual;
    usual.duration = duration;
    for (const std::string scene : {"desk", "notexture", "cabinet"})
    {
        SimulationParams params = usual;
        params.motionSpeed = 2;
        add(scene, " twice as fast", params);
        params.motionSpeed = 4;
        add(scene, " four times as fast", params);
        params = usual;
        params.exposure = 0.030;
        params.maxBlurSamples = 16;
        add(scene, " blurred", params);
        params.light = 0.1;
        add(scene, " dim", params);
    }
    for (const std::string scene : {"person", "push", "door", "half", "seated"})
    {
        SimulationParams params = usual;
        add(scene, "", params);
        params.movers = false;
        add(scene, " without what moves", params);
        params = usual;
        params.motionSpeed = 0;
        add(scene, " from a camera that stands", params);
        params.motionSpeed = 3;
        add(scene, " from a fast camera", params);
    }
    return out;
}

std::vector<SequenceSource> allSequences(const std::string& data, double duration)
{
    std::vector<SequenceSource> out =
        data.empty() ? std::vector<SequenceSource>() : tumSequences(data);
    for (SequenceSource& simulated : simulatedSequences(duration))
    {
        out.push_back(std::move(simulated));
    }
    return out;
}
}  // namespace pointplane
