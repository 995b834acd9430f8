// SPDX-License-Identifier: BSD-3-Clause
#include "FrameSource.h"

#include <pointplane/core/counted.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>
#include <pointplane/mrpt_io/output_labels.h>
#include <pointplane/mrpt_io/recording_marks.h>

#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <filesystem>
#include <utility>

namespace pointplane
{
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationComment;

namespace
{
[[nodiscard]] bool startsWith(const std::string& text, const std::string& beginning)
{
    return text.compare(0, beginning.size(), beginning) == 0;
}

/** How a rawlog is made of a folder. */
[[nodiscard]] const char* adviceOn(const std::filesystem::path& folder)
{
    std::error_code error;
    return std::filesystem::exists(folder / "depth.txt", error)
               ? "pointplane-convert tum makes one of it"
           : std::filesystem::exists(folder / "metadata.yaml", error)
               ? "if ROS 2 wrote it, make a ROS 1 bag of it (rosbags-convert), then "
                 "pointplane-convert bag makes a rawlog"
               : "pointplane-convert folder makes one of a folder with colour and depth images";
}
}  // namespace

FrameSource::FrameSource(const OdometryOptions& options, const OutputGuard& guard)
    : options_(options), guard_(guard), label_(options.sensorLabel)
{
    for (std::size_t i = 0; i < options.inputs.size(); ++i)
    {
        std::error_code error;
        const auto type = std::filesystem::status(options.inputs[i], error).type();
        if (type == std::filesystem::file_type::directory)
        {
            throw InputError(
                options.inputs[i] + ": is a folder, not a rawlog; " + adviceOn(options.inputs[i]));
        }
        if (i > 0 && type != std::filesystem::file_type::fifo)  // it can be read but once
        {
            (void)RawlogReader(options.inputs[i]);  // before the run, not in the middle of it
        }
    }
    openNext();
}

void FrameSource::openNext()
{
    reader_ = std::make_unique<RawlogReader>(options_.inputs.at(nextInput_));
    converter_.setExternalsDirectory(reader_->externalsDirectory());
    guard_.checkInputFolder(reader_->externalsDirectory());
    ++nextInput_;
}

void FrameSource::endAt(const std::string& damage)
{
    damage_ = damage;
    if (const auto left = options_.inputs.size() - nextInput_; left > 0)
    {
        damage_ += "; not read: " + options_.inputs[nextInput_] +
                   (left > 1 ? " and " + std::to_string(left - 1) + " more" : "");
    }
}

bool FrameSource::refill()
{
    while (pending_.empty())
    {
        const auto object = reader_->next();
        if (!object)
        {
            if (const std::string& damage = reader_->ending().message; !damage.empty())
            {
                endAt(damage);
                return false;
            }
            if (nextInput_ == options_.inputs.size())
            {
                return false;
            }
            openNext();
            continue;
        }
        if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
        {
            pending_.push_back(observation);
            pendingIsObject_ = true;
        }
        else if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
        {
            pending_.insert(pending_.end(), frame->begin(), frame->end());
            pendingIsObject_ = false;
        }
        else  // actions, the odometry of somebody else
        {
            ++notPassedOn_[object->GetRuntimeClass()->className];
        }
    }
    return true;
}

void FrameSource::checkExternals(const CObservation3DRangeScan& scan) const
{
    if (scan.rangeImage_isExternallyStored())
    {
        guard_.checkInput(scan.rangeImage_getExternalStorageFile(""));
    }
    for (const auto* image : {&scan.intensityImage, &scan.confidenceImage})
    {
        if (image->isExternallyStored())
        {
            guard_.checkInput(image->getExternalStorageFile());
        }
    }
}

bool FrameSource::isMark(const mrpt::obs::CObservation& observation)
{
    const auto* comment = dynamic_cast<const CObservationComment*>(&observation);
    return comment != nullptr &&
           (comment->text == kRecordingBegins || comment->text == kRecordingEnds);
}

bool FrameSource::isOfEarlierRun(const mrpt::obs::CObservation& observation) const
{
    if (const auto* comment = dynamic_cast<const CObservationComment*>(&observation))
    {
        return startsWith(comment->text, statusCommentOf(label_));
    }
    return dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation) != nullptr &&
           (observation.sensorLabel == poseLabelOf(label_) ||
            startsWith(observation.sensorLabel, sinceLabelOf(label_)));
}

std::vector<std::string> FrameSource::notes() const
{
    std::vector<std::string> out;
    for (const auto& [label, count] : framesOf_)
    {
        if (label != label_)
        {
            out.push_back(
                "not used: " + framesText(count) + " of camera '" + label +
                "' (--sensor-label chooses)");
        }
    }
    if (!options_.output.empty() && !options_.onlyPoses)
    {
        for (const auto& [name, count] : notPassedOn_)
        {
            out.push_back("not passed on: " + counted(count, "object") + " of class " + name);
        }
    }
    for (const std::string& key : converter_.unknownKeys())
    {
        out.push_back(
            "not used: key '" + key +
            "' of comments about cameras, which this version does not know");
    }
    if (isNominal_)
    {
        out.emplace_back(
            "camera: nominal intrinsics, nobody calibrated it; they count as 2 % off at first, and "
            "are learnt while the camera moves (a calibration makes poses better)");
    }
    if (numReplaced_ > 0)
    {
        out.push_back(
            "replaced: " + counted(numReplaced_, "record") +
            " (poses and comments) of an earlier run on camera '" + label_ + "'");
    }
    return out;
}

std::optional<SourceItem> FrameSource::item(const mrpt::obs::CObservation::Ptr& observation)
{
    SourceItem out;
    out.observation = observation;
    const bool copies = !options_.output.empty() && !options_.onlyPoses && pendingIsObject_;
    out.record = copies ? std::make_shared<RawlogRecord>(reader_->takeRecord()) : nullptr;
    out.progress = (static_cast<double>(nextInput_ - 1) + reader_->progress()) /
                   static_cast<double>(options_.inputs.size());
    if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(observation))
    {
        try
        {
            out.tellsOf = converter_.readComment(*comment);
        }
        catch (const InputError& e)
        {
            endAt(reader_->path() + ": " + e.what());
            return {};
        }
        return out;
    }
    if (const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
    {
        addFrame(*scan, out);
    }
    return out;
}

void FrameSource::addFrame(CObservation3DRangeScan& scan, SourceItem& out)
{
    if (makeExternalsAbsolute(scan, reader_->externalsDirectory()))
    {
        out.record.reset();
    }
    checkExternals(scan);
    ++framesOf_[scan.sensorLabel];
    if (label_.empty() && numFrames_ == 0)
    {
        label_ = scan.sensorLabel;
    }
    if (scan.sensorLabel == label_)
    {
        out.frameIndex = numFrames_++;
        if (out.frameIndex >= options_.first)
        {
            out.converted = converter_.convert(scan);
            isNominal_ = isNominal_ || out.converted->frame.camera.isNominal;
        }
    }
}

bool FrameSource::hasAllFrames() const
{
    return numFrames_ >= options_.first && numFrames_ - options_.first >= options_.count;
}

void FrameSource::skip(SourceItem item)
{
    if (!item.tellsOf.empty())
    {
        const std::string camera = item.tellsOf;
        skippedComments_[camera] = std::move(item);
    }
    start_ = std::chrono::steady_clock::now();
}

void FrameSource::deliver(SourceItem item)
{
    for (auto& [camera, comment] : skippedComments_)
    {
        ready_.push_back(std::move(comment));
    }
    skippedComments_.clear();
    ready_.push_back(std::move(item));
}

std::optional<SourceItem> FrameSource::next()
{
    while (ready_.empty() && damage_.empty() && !hasAllFrames() && refill())
    {
        const auto observation = pending_.front();
        pending_.pop_front();
        if (isMark(*observation))
        {
            continue;  // it is about the recording as a whole, which the output need not be
        }
        if (isOfEarlierRun(*observation))
        {
            ++numReplaced_;
            continue;
        }
        if (auto out = item(observation))
        {
            const bool isWanted = numFrames_ > options_.first || options_.first == 0;
            isWanted ? deliver(std::move(*out)) : skip(std::move(*out));
        }
    }
    if (ready_.empty())
    {
        return {};
    }
    SourceItem out = std::move(ready_.front());
    ready_.pop_front();
    return out;
}

std::string FrameSource::whyNoFrames() const
{
    if (!damage_.empty())
    {
        return damage_;
    }
    const std::size_t numMore = options_.inputs.size() - 1;
    const std::string inputs = options_.inputs.front() +
                               (numMore > 0 ? " and " + std::to_string(numMore) + " more: " : ": ");
    if (framesOf_.empty())
    {
        return inputs + "no CObservation3DRangeScan in it";
    }
    std::string cameras;
    for (const auto& [label, count] : framesOf_)
    {
        cameras += (cameras.empty() ? "" : ", ") + framesText(count) + " of camera '" + label + "'";
    }
    return inputs +
           (framesOf_.count(label_) > 0
                ? "--first " + std::to_string(options_.first) + " skips all of them"
                : "no frames of camera '" + label_ + "'") +
           "; in it are " + cameras;
}
}  // namespace pointplane
