// SPDX-License-Identifier: BSD-3-Clause
#include "file_check.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "OutputGuard.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Of a recording, its first parts if it is split. */
std::vector<std::string> recordingsOf(const GrabberOptions& options)
{
    constexpr int kParts = 1000;
    if (!options.recordsRawlog() || options.recording.splitAfter <= 0.0)
    {
        return {options.output};
    }
    std::vector<std::string> out;
    for (int i = 0; i < kParts; ++i)
    {
        out.push_back(segmentPath(options.output, i));
    }
    return out;
}

void keepFilesApart(const GrabberOptions& options)
{
    OutputGuard guard;
    std::error_code error;
    if (fs::is_regular_file(options.device, error))
    {
        guard.addInput(options.device);
    }
    guard.addInput(options.calibration);
    guard.addInput(options.liveOdometry.config);
    guard.addInput(options.liveOdometry.mask);
    for (const std::string& path : recordingsOf(options))
    {
        guard.addOutput("-o", path);
        if (options.recordsRawlog() && options.recording.encoding.storage == ImageStorage::External)
        {
            guard.addFolderBeside("images of -o", path, imagesFolderOf(path));
        }
    }
    guard.addOutput("--preview", options.preview);
    guard.addRawlog("--live-output", options.liveOdometry.poseRawlog);
}
}  // namespace

void checkFilesOf(const GrabberOptions& options)
{
    keepFilesApart(options);
    std::error_code error;
    if (!options.calibration.empty() && !fs::is_regular_file(options.calibration, error))
    {
        throw InputError("--calibration " + options.calibration + ": no such file");
    }
    if (!options.liveOdometry.config.empty())
    {
        (void)loadOdometryParams(options.liveOdometry.config, {});
    }
    if (!options.liveOdometry.mask.empty())
    {
        (void)readMask(options.liveOdometry.mask);
    }
    std::vector<std::string> recordings;
    if (fs::is_regular_file(options.liveOdometry.poseRawlog, error))  // not a pipe
    {
        recordings.push_back(options.liveOdometry.poseRawlog);
    }
    if (!options.output.empty())
    {
        const std::vector<std::string> ofImages = recordingsOf(options);
        recordings.insert(recordings.end(), ofImages.begin(), ofImages.end());
    }
    for (const std::string& path : recordings)
    {
        if (fs::exists(path, error))
        {
            throw InputError("'" + path + "' exists already; recordings never overwrite");
        }
    }
}
}  // namespace pointplane
