// SPDX-License-Identifier: BSD-3-Clause
#include "GrabberOutputs.h"

#include <pointplane/mrpt_io/errors.h>

#include <exception>
#include <ostream>

namespace pointplane
{
GrabberOutputs::GrabberOutputs(
    const GrabberOptions& options,
    const CameraFacts& camera,
    const ObservationBuilder& builder,
    std::ostream& out)
    : isFile_(camera.isFile), queueCapacity_(options.recording.queueFrames)
{
    if (!options.preview.empty())
    {
        preview_ = std::make_unique<Preview>(options.preview);
    }
    if (options.live)
    {
        LiveOptions live = options.liveOdometry;
        live.waits = isFile_;
        live.knowsDelay = !isFile_;  // a file's streams both start at 0
        live_ = std::make_unique<LiveOdometry>(live, builder, out);
    }
    if (options.recordsRawlog())
    {
        RecordingOptions recording = options.recording;
        recording.marksEnds = true;
        recording.tellDelay = !isFile_;
        writer_ = std::make_unique<RecordingWriter>(recording, builder);
    }
}

bool GrabberOutputs::add(const ImagePair& pair)
{
    if (writer_)
    {
        const bool taken = isFile_ ? writer_->push(pair) : writer_->tryPush(pair);
        if (!taken && writer_->hasFailed())
        {
            return false;
        }
        queueDrops_ += taken ? 0 : 1;
    }
    if (live_)
    {
        live_->add(pair);
    }
    if (preview_)
    {
        preview_->show(pair);
    }
    return true;
}

std::vector<std::string> GrabberOutputs::finish()
{
    std::vector<std::string> problems;
    if (const std::string problem = preview_ ? preview_->finish() : ""; !problem.empty())
    {
        problems.push_back(problem + "; the picture is not the latest");
    }
    try
    {
        if (writer_)
        {
            writer_->finish();
        }
    }
    catch (const std::exception& e)
    {
        problems.push_back(oneLine(e) + "; what was recorded before is complete");
    }
    try
    {
        if (live_)
        {
            live_->finish();
            if (const std::string problem = live_->stats().problem; !problem.empty())
            {
                problems.push_back(problem);
            }
        }
    }
    catch (const std::exception& e)
    {
        problems.push_back(oneLine(e));
    }
    return problems;
}

void GrabberOutputs::describeIn(RunState& state) const
{
    state.queueDrops = queueDrops_;
    if (writer_)
    {
        state.isRecording = true;
        state.recording = writer_->stats();
        state.queueCapacity = queueCapacity_;
        state.bytesPerSecond =
            state.capture.recordedTime > 0.0
                ? static_cast<double>(state.recording.bytesWritten) / state.capture.recordedTime
                : 0.0;
    }
}

void GrabberOutputs::describeIn(RunSummary& summary) const
{
    if (writer_)
    {
        summary.outputs = writer_->paths();
    }
    if (live_)
    {
        summary.hasLive = true;
        summary.live = live_->stats();
    }
}
}  // namespace pointplane
