// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** Frames with ground truth; the same for every method. */
struct BenchmarkSequence
{
    std::string name;
    std::size_t numFrames{0};
    std::function<RgbdFrame(std::size_t)> frame;
    Trajectory truth;  //!< T_world_cam, optical axes
};

/** All folders with rgb.txt, depth.txt and groundtruth.txt in `data`, in order of name. The shutter
 * is unknown but for the median delay of the stamps. \throws InputError */
[[nodiscard]] std::vector<BenchmarkSequence> tumSequences(const std::string& data);

/** The simulated scenes with a Kinect's defaults, each with its shutter told and not told. */
[[nodiscard]] std::vector<BenchmarkSequence> simulatedSequences(double duration);
}  // namespace pointplane
