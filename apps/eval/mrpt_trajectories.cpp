// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_trajectories.h"

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/SimplemapReader.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/output_labels.h>

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace pointplane
{
namespace
{
StampedPose stamped(double stamp, const PoseGaussian& pose)
{
    return {stamp, pose.mean, pose.cov, {}, FrameStatus::Tracked};
}

constexpr const char* kDigits = "0123456789";

/** What the label of a motion since an earlier frame says, LABEL_since_N beside LABEL_pose. */
struct Since
{
    std::string poseLabel;
    std::size_t framesAgo;
};

std::optional<Since> sinceOf(const std::string& label)
{
    constexpr std::size_t kMostDigits = 4;
    const std::size_t at = label.rfind(kSinceEnding);
    if (at == std::string::npos)
    {
        return std::nullopt;
    }
    const std::string number = label.substr(at + kSinceEnding.size());
    if (number.empty() || number.size() > kMostDigits || number[0] == '0' ||
        number.find_first_not_of(kDigits) != std::string::npos)
    {
        return std::nullopt;
    }
    return Since{poseLabelOf(label.substr(0, at)), std::stoul(number)};
}

/** What a comment says about the frame of a camera that was not tracked; docs/rawlogs.md. */
struct FrameMark
{
    std::string poseLabel;
    FrameStatus status;
};

std::optional<FrameMark> markOf(const std::string& comment)
{
    if (comment.compare(0, kStatusBegins.size(), kStatusBegins) != 0)
    {
        return std::nullopt;
    }
    for (std::size_t at = comment.find(kStatusFrame); at != std::string::npos;
         at = comment.find(kStatusFrame, at + 1))
    {
        const std::size_t number = at + kStatusFrame.size();
        const std::size_t end =
            std::min(comment.find_first_not_of(kDigits, number), comment.size());
        const auto says = [&](std::string_view status)
        {
            const std::size_t after = end + status.size();
            return end > number && comment.compare(end, status.size(), status) == 0 &&
                   (after == comment.size() || comment[after] == ':');
        };
        if (says(" lost") || says(" predicted"))
        {
            return FrameMark{
                poseLabelOf(comment.substr(kStatusBegins.size(), at - kStatusBegins.size())),
                says(" lost") ? FrameStatus::Lost : FrameStatus::Predicted};
        }
    }
    return std::nullopt;
}

/** pointplane-odometry writes a pose for every frame of the camera LABEL, labelled LABEL_pose.
 * LABEL may be empty. */
bool isOfOdometry(const std::string& label)
{
    return label.size() >= kPoseEnding.size() &&
           label.compare(label.size() - kPoseEnding.size(), kPoseEnding.size(), kPoseEnding) == 0;
}

/** MRPT's poses are of the robot. */
Trajectory ofRobot(const std::string& path, std::vector<StampedPose> poses)
{
    Trajectory out = makeTrajectory(path, std::move(poses));
    out.body = Body::Robot;
    return out;
}

/** Of its first observation that has one: comments need not. */
mrpt::Clock::time_point stampOf(const mrpt::obs::CSensoryFrame& frame)
{
    const auto first = std::find_if(
        frame.begin(),
        frame.end(),
        [](const auto& observation) { return observation->timestamp != INVALID_TIMESTAMP; });
    return first == frame.end() ? INVALID_TIMESTAMP : (*first)->timestamp;
}

/** Collects poses from the objects of a rawlog. */
class PoseCollector
{
 public:
    void add(const mrpt::serialization::CSerializable::Ptr& object)
    {
        if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
        {
            addObservation(*observation);
        }
        else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
        {
            addFrame(*frame);
        }
        else if (
            const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object))
        {
            addActions(*actions);
        }
    }

    /** Of the sensor `label`; empty: of the only one. \throws InputError */
    [[nodiscard]] Trajectory result(const std::string& path, const std::string& label) const;

 private:
    void addObservation(const mrpt::obs::CObservation& observation)
    {
        if (const auto* text = dynamic_cast<const mrpt::obs::CObservationComment*>(&observation))
        {
            if (const auto mark = markOf(text->text))
            {
                addMark(*mark);
            }
            if (text->text.compare(0, kSkippedBegins.size(), kSkippedBegins) == 0)
            {
                skipping_.insert(poseLabelOf(text->text.substr(kSkippedBegins.size())));
            }
        }
        if (const auto* pose = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation))
        {
            const PoseGaussian gaussian = fromMrpt(pose->pose);
            if (const auto since = sinceOf(pose->sensorLabel))
            {
                addSince(*since, toSeconds(pose->timestamp), gaussian.cov);
            }
            else
            {
                byLabel_[pose->sensorLabel].push_back(
                    stamped(toSeconds(pose->timestamp), gaussian));
            }
        }
    }

    /** Those of a pose follow it, one frame back first. */
    void addSince(const Since& since, double stamp, const Matrix6d& cov)
    {
        const auto poses = byLabel_.find(since.poseLabel);
        if (poses != byLabel_.end() && poses->second.back().stamp == stamp &&
            poses->second.back().sinceCovs.size() + 1 == since.framesAgo)
        {
            poses->second.back().sinceCovs.push_back(cov);
        }
    }

    /** It follows the pose that it is about. */
    void addMark(const FrameMark& mark)
    {
        const auto poses = byLabel_.find(mark.poseLabel);
        if (poses != byLabel_.end())
        {
            poses->second.back().status = mark.status;
        }
    }

    void addFrame(const mrpt::obs::CSensoryFrame& frame)
    {
        for (const auto& observation : frame)
        {
            addObservation(*observation);
        }
        const auto stamp = stampOf(frame);
        if (stamp != INVALID_TIMESTAMP && hasMovement_)
        {
            composed_.push_back(stamped(toSeconds(stamp), accumulated_));
        }
    }

    void addActions(const mrpt::obs::CActionCollection& actions)
    {
        if (const auto movement = actions.getActionByClass<mrpt::obs::CActionRobotMovement3D>())
        {
            hasMovement_ = true;
            accumulated_ = compose(accumulated_, fromMrpt(movement->poseChange));
        }
    }

    std::map<std::string, std::vector<StampedPose>> byLabel_;
    std::set<std::string> skipping_;     //!< labels of poses that frames are missing of
    std::vector<StampedPose> composed_;  //!< format 1's movements
    PoseGaussian accumulated_;
    bool hasMovement_{false};
};

Trajectory PoseCollector::result(const std::string& path, const std::string& label) const
{
    std::string labels;
    for (const auto& [name, poses] : byLabel_)
    {
        labels += (labels.empty() ? "'" : ", '") + name + "'";
    }
    if (byLabel_.empty())
    {
        if (composed_.empty())
        {
            throw InputError(
                "'" + path +
                "' holds no poses: neither CObservationRobotPose nor CActionRobotMovement3D");
        }
        return ofRobot(path, composed_);
    }
    if (label.empty() && byLabel_.size() > 1)
    {
        throw InputError(
            "'" + path + "' holds poses of several sensors (" + labels +
            "); choose one by --sensor-label");
    }
    const auto found = label.empty() ? byLabel_.begin() : byLabel_.find(label);
    if (found == byLabel_.end())
    {
        throw InputError(
            "'" + path + "' holds no poses with sensor label '" + label + "', only " + labels);
    }
    Trajectory trajectory = ofRobot(path, found->second);
    trajectory.marksFrames = isOfOdometry(found->first) && skipping_.count(found->first) == 0;
    return trajectory;
}
}  // namespace

Trajectory readRawlogTrajectory(const std::string& path, const std::string& sensorLabel)
{
    RawlogReader reader(path);
    PoseCollector collector;
    while (const auto object = reader.next())
    {
        collector.add(object);
    }
    const bool damaged = reader.ending().kind != RawlogEnd::Clean;
    if (damaged && reader.numObjects() == 0)
    {
        throw InputError(reader.ending().message);
    }
    Trajectory trajectory;
    try
    {
        trajectory = collector.result(path, sensorLabel);
    }
    catch (const InputError& e)
    {
        // Poses may be behind the damage.
        throw InputError(e.what() + (damaged ? "; " + reader.ending().message : std::string()));
    }
    if (damaged)
    {
        trajectory.incomplete = true;
        trajectory.warnings.push_back(
            reader.ending().message + "; only what comes before is evaluated");
    }
    return trajectory;
}

Trajectory readSimplemapTrajectory(const std::string& path)
{
    SimplemapReader reader(path);
    std::vector<StampedPose> poses;
    while (const auto keyFrame = reader.next())
    {
        const auto stamp = stampOf(*keyFrame->observations);
        if (stamp == INVALID_TIMESTAMP)
        {
            throw InputError(
                "'" + path + "': key frame " + std::to_string(poses.size()) +
                " has no observation with a time stamp");
        }
        mrpt::poses::CPose3DPDFGaussian gaussian;
        gaussian.copyFrom(*keyFrame->pose);
        poses.push_back(stamped(toSeconds(stamp), fromMrpt(gaussian)));
    }
    if (poses.empty())
    {
        throw InputError("'" + path + "' holds no key frames");
    }
    return ofRobot(path, std::move(poses));
}
}  // namespace pointplane
