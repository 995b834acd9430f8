// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/grabber/LiveOdometry.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/mrpt_io/output_labels.h>

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <iomanip>
#include <ostream>
#include <sstream>

#include "lowPriority.h"

namespace pointplane
{
namespace
{
constexpr int kPoseSize = 6;

std::string lineOf(const RobotMotion& motion, double stamp)
{
    std::ostringstream line = numberStream();
    line << std::setprecision(6) << std::fixed << stamp << " " << toString(motion.status);
    for (int i = 0; i < kPoseSize; ++i)
    {
        line << " " << motion.pose.mean[static_cast<unsigned>(i)];
    }
    line << std::scientific;
    for (int row = 0; row < kPoseSize; ++row)
    {
        for (int col = row; col < kPoseSize; ++col)
        {
            line << " " << motion.pose.cov(row, col);
        }
    }
    return line.str();
}
}  // namespace

LiveOdometry::LiveOdometry(
    const LiveOptions& options, const ObservationBuilder& builder, std::ostream& out)
    : options_(options), builder_(builder), out_(out), camera_(builder.calibration().sensorLabel)
{
    if (!options_.config.empty())
    {
        odometry_.loadFromConfigFileName(options_.config);
    }
    if (!options_.mask.empty())
    {
        const cv::Mat mask = readMask(options_.mask);
        const RgbdCalibration& camera = builder_.calibration();
        requireMaskSize(
            options_.mask,
            mask.size(),
            cv::Size(static_cast<int>(camera.colour.ncols), static_cast<int>(camera.colour.nrows)),
            camera.sensorLabel);
        odometry_.setMask(mask);
    }
    odometry_.setMinLoggingLevel(mrpt::system::LVL_ERROR);  // the lines say what was not tracked
    if (!options_.poseRawlog.empty())
    {
        rawlog_ = std::make_unique<RawlogWriter>(options_.poseRawlog);
    }
    out_
        << "# stamp status x y z yaw pitch roll [m rad] covariance: 21 upper-triangular elements\n";
    thread_ = std::thread([this] { work(); });
}

LiveOdometry::~LiveOdometry()
{
    latest_.close();
    if (thread_.joinable())
    {
        thread_.join();
    }
}

void LiveOdometry::add(const ImagePair& pair)
{
    options_.waits ? latest_.putWhenTaken(pair) : latest_.put(pair);
}

void LiveOdometry::work()
{
    if (!options_.waits)
    {
        lowerThreadPriority();
    }
    while (const auto pair = latest_.take())
    {
        try
        {
            process(*pair);
        }
        catch (const std::exception& e)
        {
            rawlog_.reset();  // stays partial
            giveUp(e, "--live ends there");
            break;
        }
    }
    latest_.close();  // nobody waits for the next frame to be taken
}

/** The recording goes on: it has priority. */
void LiveOdometry::giveUp(const std::exception& e, const std::string& what)
{
    const std::lock_guard<std::mutex> lock(mutex_);
    stats_.problem = oneLine(e) + "; " + what + ", the rest went on";
}

/** What the recording would tell before this frame. */
void LiveOdometry::readNews(const ImagePair& pair)
{
    const std::string news = camera_.before(
        options_.knowsDelay ? pair.depthDelay() : ShutterModel::kUnknown,
        builder_.calibration().isNominal);
    if (!news.empty())
    {
        mrpt::obs::CObservationComment comment;
        comment.text = news;
        odometry_.converter().readComment(comment);
    }
}

void LiveOdometry::process(const ImagePair& pair)
{
    readNews(pair);
    mrpt::obs::CObservation3DRangeScan observation;
    builder_.fill(pair, observation);
    const RobotMotion motion = odometry_.process(observation);
    out_ << lineOf(motion, pair.stamp) << std::endl;
    write(motion, observation.timestamp);

    const std::lock_guard<std::mutex> lock(mutex_);
    ++stats_.processed;
    stats_.notTracked += isMeasured(motion.status) ? 0 : 1;
}

void LiveOdometry::write(const RobotMotion& motion, mrpt::Clock::time_point stamp)
{
    if (!rawlog_)
    {
        return;
    }
    mrpt::obs::CObservationRobotPose pose;
    const std::string& camera = builder_.calibration().sensorLabel;
    pose.sensorLabel = poseLabelOf(camera);
    pose.timestamp = stamp;
    pose.pose = motion.pose;
    try
    {
        rawlog_->write(pose);
        if (!isMeasured(motion.status))
        {
            mrpt::obs::CObservationComment comment;
            comment.timestamp = stamp;
            comment.text =
                statusCommentOf(camera, stats().processed, toString(motion.status), motion.reason);
            rawlog_->write(comment);
        }
    }
    catch (const EnvironmentError& e)
    {
        rawlog_.reset();
        giveUp(e, "--live-output ends there");
    }
}

void LiveOdometry::finish()
{
    latest_.close();
    thread_.join();
    if (!rawlog_)
    {
        return;
    }
    if (latest_.numReplaced() > 0)
    {
        mrpt::obs::CObservationComment comment;
        comment.timestamp = mrpt::Clock::now();
        comment.text = skippedCommentOf(builder_.calibration().sensorLabel);
        rawlog_->write(comment);
    }
    rawlog_->close();
}

LiveStats LiveOdometry::stats() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    LiveStats stats = stats_;
    stats.skipped = latest_.numReplaced();
    return stats;
}
}  // namespace pointplane
