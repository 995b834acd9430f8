// SPDX-License-Identifier: BSD-3-Clause
#include "GroundTruthBenchmark.h"

#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <ostream>

#include "TruthRotationNoise.h"
#include "selection.h"
#include "sequences.h"
#include "text_file.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kMinPairs = 20;
constexpr std::size_t kProgressStep = 50;  //!< frames

/** A frame and where the ground truth says it was taken, if it does. */
struct PosedFrame
{
    RgbdFrame frame;
    std::optional<Eigen::Isometry3d> T_world_cam;
};

/** \return "a SEP b SEP c" */
[[nodiscard]] std::string inDegrees(const Eigen::Vector3d& sigma, const char* separator)
{
    const Eigen::Vector3d deg = sigma * kDegreesPerRadian;
    char out[96];
    std::snprintf(
        out, sizeof out, "%.3f%s%.3f%s%.3f", deg.x(), separator, deg.y(), separator, deg.z());
    return out;
}

[[nodiscard]] std::string tracksOf(const RotationNoise& noise)
{
    char out[32];
    std::snprintf(out, sizeof out, "%.0f", noise.meanTracks);
    return out;
}

[[nodiscard]] std::string row(
    const std::string& name, std::size_t distance, const RotationNoise& noise)
{
    return "| " + name + " | " + std::to_string(distance) + " | " + std::to_string(noise.numPairs) +
           " | " + tracksOf(noise) + " | " + inDegrees(noise.sigma, " / ") + " | " +
           inDegrees(noise.sigmaOfTracks, " / ") + " |\n";
}

[[nodiscard]] std::string csvLine(
    const std::string& name, std::size_t distance, const RotationNoise& noise)
{
    return name + "," + std::to_string(distance) + "," + std::to_string(noise.numPairs) + "," +
           tracksOf(noise) + "," + inDegrees(noise.sigma, ",") + "," +
           inDegrees(noise.sigmaOfTracks, ",") + "\n";
}

/** Ground truth, interpolated at the stamp of a frame. */
[[nodiscard]] PosedFrame posed(RgbdFrame frame, const Trajectory& truth)
{
    const SampledTruth sample = sampleTruth(truth, {frame.stamp}, 0, TruthAt::Interpolated);
    PosedFrame out{std::move(frame), {}};
    if (sample.valid.front() != 0)
    {
        out.T_world_cam = sample.poses.front();
    }
    return out;
}
}  // namespace

GroundTruthBenchmark::GroundTruthBenchmark(CLI::App& app)
{
    app.add_option("--data", data_, "folder with TUM sequences; without it only simulated scenes")
        ->envname("POINTPLANE_DATA");
    app.add_option("--sequences", sequences_, "only those with one of these in their name")
        ->delimiter(',');
    app.add_option("--frames", distances_, "distances between the images of a pair [frames]")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app.add_option("--duration", duration_, "of simulated scenes [s]")
        ->capture_default_str()
        ->check(CLI::Range(2.0, 600.0));
    app.add_option("--csv", csvFile_, "also write the table to this file, for programs");
}

std::vector<TruthRotationNoise> GroundTruthBenchmark::measure(
    const SequenceSource& source, std::ostream& err) const
{
    const BenchmarkSequence sequence = source.open();
    const std::size_t farthest = *std::max_element(distances_.begin(), distances_.end());
    std::vector<TruthRotationNoise> noise(distances_.size());
    std::map<std::size_t, PosedFrame> frames;
    for (std::size_t k = 0; k < sequence.numFrames; ++k)
    {
        const PosedFrame& to =
            frames.emplace(k, posed(sequence.frame(k), sequence.truth)).first->second;
        for (std::size_t m = 0; m < distances_.size(); ++m)
        {
            const auto from = k < distances_[m] ? frames.end() : frames.find(k - distances_[m]);
            if (from != frames.end() && from->second.T_world_cam && to.T_world_cam)
            {
                noise[m].add(
                    from->second.frame,
                    to.frame,
                    to.T_world_cam->inverse() * *from->second.T_world_cam);
            }
        }
        if (k >= farthest)
        {
            frames.erase(k - farthest);
        }
        if ((k + 1) % kProgressStep == 0 || k + 1 == sequence.numFrames)
        {
            err << source.name << ": frame " << k + 1 << " of " << sequence.numFrames << "\n";
        }
    }
    return noise;
}

void GroundTruthBenchmark::run(std::ostream& out, std::ostream& err) const
{
    std::string lines;
    const std::string header =
        "sequence,frames,pairs,tracks,sigma_x_deg,sigma_y_deg,sigma_z_deg,"
        "tracks_x_deg,tracks_y_deg,tracks_z_deg\n";
    out << "Noise of the ground truth's rotation per pose about the camera's axes x / y / z [deg], "
           "and what the tracks contributed, which has been subtracted.\n\n"
           "| sequence | frames apart | pairs | tracks | ground truth | tracks' own |\n"
           "|---|---|---|---|---|---|\n";
    for (const SequenceSource& source :
         wantedOf(allSequences(data_, duration_), sequences_, "--sequences"))
    {
        const std::vector<TruthRotationNoise> noise = measure(source, err);
        for (std::size_t m = 0; m < noise.size(); ++m)
        {
            const RotationNoise result = noise[m].result();
            if (result.numPairs < kMinPairs)
            {
                err << source.name << ": left out at " << distances_[m] << " frames, where only "
                    << result.numPairs << " pairs have enough corners with depth\n";
                continue;
            }
            out << row(source.name, distances_[m], result) << std::flush;
            lines += csvLine(source.name, distances_[m], result);
        }
    }
    if (lines.empty())
    {
        throw InputError("no sequence has enough corners with depth to measure anything");
    }
    if (!csvFile_.empty())
    {
        writeTextFile(csvFile_, header + lines);
    }
}
}  // namespace pointplane
