// SPDX-License-Identifier: BSD-3-Clause
#include "text_sinks.h"

#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "tum_line.h"

namespace pointplane
{
TrajectorySink::TrajectorySink(const std::string& path, bool robotFrame)
    : TextSink(path), robotFrame_(robotFrame)
{
    file_.writeLine(
        std::string("# timestamp tx ty tz qx qy qz qw; poses of the ") +
        (robotFrame ? "robot, x forward, y left, z up" : "camera, x right, y down, z forward") +
        ", in its first frame");
    file_.writeLine(
        "# pointplane-status: lost frames have no pose, predicted ones were not measured");
}

void TrajectorySink::add(const OutputItem& item)
{
    if (!item.frame)
    {
        return;
    }
    const RobotMotion& motion = item.frame->motion;
    const bool lost = motion.status == TrackingStatus::Lost;
    if (lost || motion.status == TrackingStatus::Predicted)
    {
        file_.writeLine(
            "# pointplane-status " + stampText(item.source.observation->timestamp) + " " +
            toString(motion.status) + ": " + motion.reason);
    }
    if (lost)
    {
        return;
    }
    const Eigen::Isometry3d T =
        robotFrame_ ? fromMrpt(item.frame->motion.pose.mean) : item.frame->motion.cameraPose.mean;
    file_.writeLine(tumLine(item.source.observation->timestamp, T));
}

std::string TrajectorySink::description() const
{
    return file_.path() + ": trajectory of the " + (robotFrame_ ? "robot" : "camera") +
           ", TUM text";
}

DiagnosticsSink::DiagnosticsSink(const std::string& path) : TextSink(path)
{
    file_.writeLine(
        "frame,stamp,status,reason,numPoints,numPlanes,numPointPairs,numPlanePairs,numPointInliers,"
        "numPointsDoubted,numPointsRejected,numReferences,iterations,observableDirections,"
        "pointChi2PerDof,planeChi2PerDof,surfaceAgreement,movingShare,attachedShare,"
        "maxSigmaTranslation,maxSigmaRotation,"
        "msPoints,msPlanes,msMatching,msPose,msTotal");
}

void DiagnosticsSink::add(const OutputItem& item)
{
    if (!item.frame)
    {
        return;
    }
    const RobotMotion& motion = item.frame->motion;
    const FrameDiagnostics& d = motion.diagnostics;
    std::string reason = motion.reason;
    std::replace(reason.begin(), reason.end(), '"', '\'');
    std::ostringstream out;
    out << item.source.frameIndex << ',' << stampText(item.source.observation->timestamp) << ','
        << toString(motion.status) << ",\"" << reason << "\"," << d.numPoints << ',' << d.numPlanes
        << ',' << d.numPointPairs << ',' << d.numPlanePairs << ',' << d.numPointInliers << ','
        << d.numPointsDoubted << ',' << d.numPointsRejected << ',' << d.numReferences << ','
        << d.iterations << ',' << d.observableDirections;
    out << std::setprecision(6) << ',' << d.pointChi2PerDof << ',' << d.planeChi2PerDof << ','
        << d.surfaceAgreement << ',' << d.movingShare << ',' << d.attachedShare << ','
        << d.maxSigmaTranslation << ',' << d.maxSigmaRotation;
    out << std::fixed << std::setprecision(3) << ',' << d.msPoints << ',' << d.msPlanes << ','
        << d.msMatching << ',' << d.msPose << ',' << d.msTotal;
    file_.writeLine(out.str());
}

std::string DiagnosticsSink::description() const { return file_.path() + ": one line per frame"; }
}  // namespace pointplane
