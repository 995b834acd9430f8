// SPDX-License-Identifier: BSD-3-Clause
#include "load_trajectory.h"

#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/errors.h>

#include <filesystem>
#include <fstream>
#include <ostream>

#include "command.h"
#include "mrpt_trajectories.h"

namespace pointplane
{
namespace
{
bool endsWith(const std::string& text, const std::string& ending)
{
    return text.size() >= ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

Trajectory readByEnding(const std::string& path, const std::string& sensorLabel)
{
    for (const char* compression : {"", ".gz"})
    {
        if (endsWith(path, std::string(".rawlog") + compression))
        {
            return readRawlogTrajectory(path, sensorLabel);
        }
        if (endsWith(path, std::string(".simplemap") + compression))
        {
            return readSimplemapTrajectory(path);
        }
    }
    std::error_code error;  // what is read from a pipe is gone
    if (std::filesystem::is_regular_file(path, error) &&
        std::ifstream(path, std::ios::binary).get() == 0x1f)  // of gz
    {
        throw InputError(
            path + ": is compressed, not text; rawlogs end in .rawlog, maps in .simplemap");
    }
    return readTrajectoryText(path);
}
}  // namespace

Trajectory loadTrajectory(
    const std::string& path, const std::string& sensorLabel, CommandContext& context)
{
    Trajectory trajectory = readByEnding(path, sensorLabel);
    for (const std::string& warning : trajectory.warnings)
    {
        context.tell("warning", warning);
    }
    if (trajectory.incomplete)
    {
        context.exitCode = kExitIncomplete;
    }
    return trajectory;
}
}  // namespace pointplane
