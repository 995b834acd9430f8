// SPDX-License-Identifier: BSD-3-Clause
#include "map_sinks.h"

#include <pointplane/core/counted.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <cstdio>

namespace pointplane
{
namespace
{
/** "x y z roll pitch yaw" */
[[nodiscard]] std::string poseText(const mrpt::poses::CPose3D& pose)
{
    char text[192];
    std::snprintf(
        text,
        sizeof(text),
        "%.9f %.9f %.9f %.12f %.12f %.12f",
        pose.x(),
        pose.y(),
        pose.z(),
        pose.roll(),
        pose.pitch(),
        pose.yaw());
    return text;
}

/** Upper triangle of the information matrix, order x y z roll pitch yaw. */
[[nodiscard]] std::string informationText(const mrpt::poses::CPose3DPDFGaussian& pdf)
{
    const Matrix6d cov = pdf.cov.asEigen();
    const Matrix6d information = cov.llt().solve(Matrix6d::Identity());
    static constexpr int kOrder[6] = {0, 1, 2, 5, 4, 3};  // MRPT: x y z yaw pitch roll
    std::string out;
    for (int i = 0; i < 6; ++i)
    {
        for (int j = i; j < 6; ++j)
        {
            char text[32];
            std::snprintf(text, sizeof(text), " %.10g", information(kOrder[i], kOrder[j]));
            out += text;
        }
    }
    return out;
}
}  // namespace

SimplemapSink::SimplemapSink(const std::string& path, double distance, double angleDeg)
    : path_(path), distance_(distance), angleDeg_(angleDeg), writer_(path)
{
}

void SimplemapSink::add(const OutputItem& item)
{
    if (!item.frame || !isMeasured(item.frame->motion.status))
    {
        return;
    }
    const mrpt::poses::CPose3D& pose = item.frame->motion.pose.mean;
    if (latest_)
    {
        const mrpt::poses::CPose3D moved = pose - *latest_;
        const double angleDeg = so3Log(fromMrpt(moved).linear()).norm() * 180 / M_PI;
        if (moved.norm() < distance_ && angleDeg < angleDeg_)
        {
            return;
        }
    }
    latest_ = pose;
    writer_.add(
        item.frame->motion.pose,
        std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(item.source.observation));
}

std::string SimplemapSink::description() const
{
    return path_ + ": " + counted(writer_.size(), "key frame") + ", CSimpleMap";
}

GraphSink::GraphSink(const std::string& path) : TextSink(path) {}

void GraphSink::add(const OutputItem& item)
{
    if (!item.frame)
    {
        return;
    }
    const RobotMotion& motion = item.frame->motion;
    const std::string id = std::to_string(numNodes_);
    file_.writeLine("VERTEX3 " + id + " " + poseText(motion.pose.mean));
    if (numNodes_ == 0)
    {
        file_.writeLine("FIX 0");
    }
    else
    {
        file_.writeLine(
            "EDGE3 " + std::to_string(numNodes_ - 1) + " " + id + " " +
            poseText(motion.increment.mean) + informationText(motion.increment));
    }
    ++numNodes_;
}

std::string GraphSink::description() const
{
    return file_.path() + ": pose graph of " + counted(numNodes_, "node");
}
}  // namespace pointplane
