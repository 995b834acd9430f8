// SPDX-License-Identifier: BSD-3-Clause
#include "tum_truth.h"

#include <pointplane/core/read_errors.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "image_names.h"
#include "tum_line.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** \return nothing if there is no such file */
[[nodiscard]] std::optional<std::string> textOf(const std::string& path)
{
    if (!fs::exists(path))
    {
        return {};
    }
    std::ifstream in(path, std::ios::binary);
    if (!in || !fs::is_regular_file(path))
    {
        throw InputError("cannot read " + path + ": " + (in ? "not a file" : std::strerror(errno)));
    }
    const std::string text = readAll(in);
    requireRead(in, path);
    return text;
}

/** Whether there is more than comments. */
[[nodiscard]] bool hasPoses(const std::string& text)
{
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        if (const std::string words = trimmed(line); !words.empty() && words[0] != '#')
        {
            return true;
        }
    }
    return false;
}

/** As published with Bonn's data set. Its rotation has a scale, which is no part of a pose. */
[[nodiscard]] Eigen::Isometry3d cameraOnBonnsMarkers()
{
    Eigen::Matrix3d R;
    R << 1.0157, 0.1828, -0.2389,  //
        0.0009, -0.8431, -0.6413,  //
        -0.3009, 0.6147, -0.8085;
    const double scale = std::cbrt(R.determinant());
    Eigen::Isometry3d out(Eigen::Quaterniond(Eigen::Matrix3d(R / scale)).normalized());
    out.translation() << 0.0113, -0.0098, 0.0111;
    return out;
}

/** Poses of the camera, of a file with those of Bonn's markers in the axes of its recorder. */
[[nodiscard]] std::string truthOfBonn(const std::string& path)
{
    Eigen::Isometry3d axes = Eigen::Isometry3d::Identity();  // as published, their own inverse
    axes.linear() << -1, 0, 0, 0, 0, 1, 0, 1, 0;
    const Eigen::Isometry3d T_markers_camera = cameraOnBonnsMarkers();
    try
    {
        std::string out;
        const Trajectory markers = readTrajectoryText(path);
        for (std::size_t k = 0; k < markers.size(); ++k)
        {
            const Eigen::Isometry3d pose = axes * markers.poses[k] * axes * T_markers_camera;
            out += tumLine(fromSeconds(markers.stamps[k]), pose) + "\n";
        }
        return out;
    }
    catch (const std::runtime_error& error)
    {
        throw InputError(error.what());
    }
}
}  // namespace

TumTruth readTumTruth(const std::string& folder)
{
    const std::string path = folder + "/groundtruth.txt";
    const auto text = textOf(path);
    if (!text)
    {
        return {};
    }
    if (!hasPoses(*text))
    {
        return {"", path + ": has no poses, so no ground truth is written"};
    }
    if (isInNameOf(folder, "rgbd_bonn"))
    {
        return {truthOfBonn(path), path + ": poses of the markers, moved to the camera"};
    }
    return {*text, ""};
}
}  // namespace pointplane
