// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace pointplane
{
/** The command line of pointplane-odometry. */
struct OdometryOptions
{
    std::vector<std::string> inputs;
    std::string config;
    std::vector<std::string> settings;  //!< Section.key=value
    std::string mask;                   //!< image file; empty = none
    std::string sensorLabel;            //!< empty: that of the first RGB-D observation

    std::string output;
    std::string trajectory;
    std::string trajectoryFrame{"optical"};  //!< or "robot"
    std::string diagnostics;
    std::string overlay;          //!< folder
    std::size_t overlayEvery{1};  //!< a picture of each so many frames
    bool onlyPoses{false};
    bool format1{false};
    int since{0};            //!< motions since so many frames before, in the rawlog
    bool withPoints{false};  //!< point clouds in the rawlog's scans
    std::string simplemap;
    double keyframeDistance{0.2};   //!< between key frames of the simplemap [m]
    double keyframeAngleDeg{10.0};  //!< or rotation [deg]
    std::string graph;

    std::size_t first{0};  //!< frames left out at the start
    std::size_t count{std::numeric_limits<std::size_t>::max()};
    int jobs{3};  //!< 1: everything in one thread
    bool profile{false};
    bool quiet{false};
};
}  // namespace pointplane
