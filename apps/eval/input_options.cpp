// SPDX-License-Identifier: BSD-3-Clause
#include "input_options.h"

#include <pointplane/core/number_text.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/stamp_intervals.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "FileIdentity.h"
#include "command.h"
#include "load_trajectory.h"
#include "result_output.h"

namespace pointplane
{
void InputOptions::addTo(CLI::App& command)
{
    command
        .add_option(
            "--body-from-gt",
            bodyFromTruth,
            "Pose of the ground truth's body in the estimate's: x,y,z,yaw,pitch,roll [m, deg], or "
            "'optical' for TUM's camera axes and an estimate in MRPT's")
        ->type_name("POSE")
        ->group("Input");
    command
        .add_option(
            "--sensor-label",
            sensorLabel,
            "Which CObservationRobotPose of a rawlog (default: the only one)")
        ->type_name("LABEL")
        ->group("Input");
}

std::vector<double> numbersFromOption(const std::string& text)
{
    std::istringstream words(text + ',');  // so that a comma at the end is an empty word
    std::vector<double> out;
    for (std::string word; std::getline(words, word, ',');)
    {
        const auto number = parseFinite(trimmed(word));
        if (!number)
        {
            return {};
        }
        out.push_back(*number);
    }
    return out;
}

namespace
{
/** Pose from "x,y,z,yaw,pitch,roll" [m, deg], in MRPT's order and convention, or from "optical":
 * optical axes (x right, y down, z forward) in a body with x forward, y left, z up. */
Eigen::Isometry3d poseFromOption(const std::string& text)
{
    if (text == "optical")
    {
        return poseFromOption("0,0,0,-90,0,-90");
    }
    const std::vector<double> v = numbersFromOption(text);
    if (v.size() != 6)
    {
        throw std::invalid_argument(
            "'" + text + "' is not a pose: give x,y,z,yaw,pitch,roll in m and deg, or optical");
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(v[3] / kDegreesPerRadian, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(v[4] / kDegreesPerRadian, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(v[5] / kDegreesPerRadian, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() << v[0], v[1], v[2];
    return pose;
}
}  // namespace

Eigen::Isometry3d InputOptions::T_truth_body() const
{
    return bodyFromTruth.empty() ? Eigen::Isometry3d::Identity()
                                 : poseFromOption(bodyFromTruth).inverse();
}

std::string hintAtBodies(
    const InputOptions& input, const Trajectory& truth, const Trajectory& estimate)
{
    const bool areTold = truth.body != Body::Unknown && estimate.body != Body::Unknown;
    if (!input.bodyFromTruth.empty() || !areTold || truth.body == estimate.body)
    {
        return "";
    }
    const bool isCamera = truth.body == Body::Camera;
    return format(
        "the poses of '%s' are of the %s, those of '%s' of the %s; give --body-from-gt %s if "
        "sensorPose is 0, else the pose of the one on the other",
        truth.name.c_str(),
        isCamera ? "camera" : "robot",
        estimate.name.c_str(),
        isCamera ? "robot" : "camera",
        isCamera ? "optical" : "0,0,0,0,-90,90");
}

std::string hintAtAxes(
    const InputOptions& input,
    const Trajectory& truth,
    const Trajectory& estimate,
    double score,
    double share,
    const std::string& name,
    const std::function<double(const Eigen::Isometry3d& T_truth_body)>& scoreWith)
{
    if (!input.bodyFromTruth.empty() || truth.body != Body::Unknown || estimate.body != Body::Robot)
    {
        return hintAtBodies(input, truth, estimate);
    }
    const double optical = scoreWith(poseFromOption("optical").inverse());
    return optical < share * score
               ? format(
                     "with --body-from-gt optical the %s would be %.6g instead of %.6g; are the "
                     "poses of '%s' in other axes than the ground truth?",
                     name.c_str(),
                     optical,
                     score,
                     estimate.name.c_str())
               : "";
}

std::string hintAtAxes(
    const InputOptions& input,
    const Trajectory& truth,
    const Trajectory& estimate,
    const RpeResult& result,
    const RpeOptions& options)
{
    return hintAtAxes(
        input,
        truth,
        estimate,
        result.translation.rmse,
        0.5,
        "translation RMSE in m",
        [&](const Eigen::Isometry3d& T_truth_body) {
            return relativePoseError(withBody(truth, T_truth_body), estimate, options)
                .translation.rmse;
        });
}

void checkOrder(const Trajectory& truth, const Trajectory& estimate, CommandContext& context)
{
    if (FileIdentity(truth.name).isSame(FileIdentity(estimate.name)))
    {
        context.tell(
            "warning", "'" + estimate.name + "' is the ground truth, too: nothing is compared");
    }
    const auto isZero = [](const Matrix6d& cov) { return cov.isZero(0); };
    const auto isOfOdometry = [&](const Trajectory& t)
    { return t.marksFrames || !std::all_of(t.covs.begin(), t.covs.end(), isZero); };
    if (isOfOdometry(truth) && !isOfOdometry(estimate))
    {
        context.tell(
            "warning",
            "'" + truth.name + "' has " +
                (truth.marksFrames ? "marks of tracked and lost frames" : "covariances") +
                ", and '" + estimate.name + "' has not; is the ground truth given first?");
    }
}

void checkTruthRate(const Trajectory& truth, const Trajectory& estimate, CommandContext& context)
{
    const double ofTruth = medianInterval(truth.stamps);
    const double ofEstimate = medianInterval(estimate.stamps);
    if (ofTruth > 2.5 * ofEstimate && ofEstimate > 0)
    {
        context.tell(
            "warning",
            format(
                "'%s' has a pose every %.3g s, '%s' every %.3g s: how the camera moves between "
                "poses of the ground truth is not known, and counts as an error of the estimate",
                truth.name.c_str(),
                ofTruth,
                estimate.name.c_str(),
                ofEstimate));
    }
}

Trajectory InputOptions::loadTruth(const std::string& path, CommandContext& context) const
{
    return loadTrajectory(path, "", context);
}

Trajectory InputOptions::loadTruthOfBody(const std::string& path, CommandContext& context) const
{
    return withBody(loadTruth(path, context), T_truth_body());
}

Trajectory InputOptions::loadEstimate(const std::string& path, CommandContext& context) const
{
    return loadTrajectory(path, sensorLabel, context);
}
}  // namespace pointplane
