// SPDX-License-Identifier: BSD-3-Clause
// Any bytes as a trajectory, and as the image listing of a TUM folder.
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/errors.h>

#include <cmath>

#include "TumFolder.h"
#include "fuzzing.h"

namespace
{
using namespace pointplane;

void readTrajectory(const fuzzing::MemoryFile& file)
{
    try
    {
        const Trajectory trajectory = readTrajectoryText(file.path());
        fuzzing::require(!trajectory.empty(), "a trajectory that was read has poses");
        fuzzing::require(trajectory.size() == trajectory.poses.size(), "a stamp for each pose");
        for (std::size_t i = 0; i < trajectory.size(); ++i)
        {
            const Eigen::Isometry3d& pose = trajectory.poses[i];
            fuzzing::require(pose.matrix().allFinite(), "a finite pose");
            fuzzing::require(pose.linear().isUnitary(1e-6), "a rotation");
            fuzzing::require(
                i == 0 || trajectory.stamps[i] > trajectory.stamps[i - 1], "stamps in order");
        }
        for (const std::string& warning : trajectory.warnings)
        {
            fuzzing::requireOneLine(warning);
        }
    }
    catch (const std::runtime_error& error)
    {
        fuzzing::requireOneLine(error.what());
    }
}

void readListing(const fuzzing::MemoryFile& file)
{
    try
    {
        const auto images = readTumListing(fuzzing::MemoryFile::folder(), file.name());
        fuzzing::require(!images.empty(), "a listing that was read has images");
        for (std::size_t i = 0; i < images.size(); ++i)
        {
            fuzzing::require(std::isfinite(images[i].seconds), "a finite stamp");
            fuzzing::require(i == 0 || images[i - 1].stamp <= images[i].stamp, "stamps in order");
        }
    }
    catch (const InputError& error)
    {
        fuzzing::requireOneLine(error.what());
    }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const fuzzing::MemoryFile file;
    file.assign(data, size);
    readTrajectory(file);
    readListing(file);
    return 0;
}
