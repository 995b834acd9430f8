// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** What the ground truth of a sequence is good for. */
enum class Truth
{
    Exact,  //!< up to noise that is stated
    Loose,  //!< another odometry's: drifts and errs in scale
    None
};

/** Frames, the same for every method. */
struct BenchmarkSequence
{
    std::string name;
    Truth kind{Truth::Exact};
    std::size_t numFrames{0};
    bool isHardAlready{false};                    //!< needs no further conditions to be a trial
    std::function<RgbdFrame(std::size_t)> frame;  //!< read or rendered anew at every call
    Trajectory truth;                             //!< T_world_cam, optical axes; may be empty
    NeesOptions nees;                             //!< how noisy the truth itself is
};

/** A sequence that costs nothing until it is opened. */
struct SequenceSource
{
    std::string name;
    std::function<BenchmarkSequence()> open;
};

/** All folders with rgb.txt, depth.txt and groundtruth.txt in `data`, in order of name. Of the
 * shutter the delay between each frame's stamps is known. The ground truth of folders called
 * tum_... or rgbd_dataset_... is motion capture: 0.1 mm and 0.06 deg of noise per pose and axis;
 * that of others is exact. */
[[nodiscard]] std::vector<SequenceSource> tumSequences(const std::string& data);

/** The same and folders without a groundtruth.txt. The truth of folders called iphone_... is the
 * phone's own odometry: loose. */
[[nodiscard]] std::vector<SequenceSource> recordedSequences(const std::string& data);

/** Simulated scenes through a first generation Kinect, rolling shutter included, which the frames
 * tell. \param duration [s] */
[[nodiscard]] std::vector<SequenceSource> simulatedSequences(double duration);

/** Simulated scenes, moved 2 and 4 times as fast, blurred by exposures of 30 ms, in a tenth of the
 * light with such exposures; and those in which something moves, without that, and with a camera
 * that stands or goes three times as fast. \param duration [s] */
[[nodiscard]] std::vector<SequenceSource> hardSimulatedSequences(double duration);

/** Both, with the simulated ones alone when `data` is empty. */
[[nodiscard]] std::vector<SequenceSource> allSequences(const std::string& data, double duration);
}  // namespace pointplane
