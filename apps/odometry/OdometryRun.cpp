// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryRun.h"

#include <pointplane/core/BoundedQueue.h>
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>
#include <pointplane/odometry/robot_mask.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "FrameSource.h"
#include "OutputGuard.h"
#include "OverlaySink.h"
#include "ProgressBar.h"
#include "RawlogSink.h"
#include "Worker.h"
#include "frames_text.h"
#include "map_sinks.h"
#include "text_sinks.h"

namespace pointplane
{
namespace
{
using Sinks = std::vector<std::unique_ptr<Sink>>;

template <class S, class... Args>
void addSink(Sinks& sinks, const std::string& option, const Args&... args)
{
    try
    {
        sinks.push_back(std::make_unique<S>(args...));
    }
    catch (const EnvironmentError& e)
    {
        throw EnvironmentError(option + ": " + e.what());
    }
}

[[nodiscard]] Sinks openSinks(const OdometryOptions& options)
{
    Sinks sinks;
    if (!options.output.empty())
    {
        addSink<RawlogSink>(sinks, "-o", options);
    }
    if (!options.simplemap.empty())
    {
        addSink<SimplemapSink>(
            sinks,
            "--simplemap",
            options.simplemap,
            options.keyframeDistance,
            options.keyframeAngleDeg);
    }
    if (!options.graph.empty())
    {
        addSink<GraphSink>(sinks, "--graph", options.graph);
    }
    if (!options.trajectory.empty())
    {
        addSink<TrajectorySink>(
            sinks, "--trajectory", options.trajectory, options.trajectoryFrame == "robot");
    }
    if (!options.diagnostics.empty())
    {
        addSink<DiagnosticsSink>(sinks, "--diagnostics", options.diagnostics);
    }
    if (!options.overlay.empty())
    {
        addSink<OverlaySink>(sinks, "--overlay", options.overlay, options.overlayEvery);
    }
    return sinks;
}

[[nodiscard]] OutputGuard guardOf(const OdometryOptions& options)
{
    OutputGuard guard;
    guard.addInput(options.config);
    guard.addInput(options.mask);
    for (const std::string& input : options.inputs)
    {
        guard.addInputRawlog(input);
    }
    guard.addOutput("--simplemap", options.simplemap);
    guard.addText("--graph", options.graph);
    guard.addText("--trajectory", options.trajectory);
    guard.addText("--diagnostics", options.diagnostics);
    guard.addOutputFolder("--overlay", options.overlay, ".jpg");
    guard.addRawlog("-o", options.output);
    return guard;
}

/** The run, in one thread or in three. */
class Run
{
 public:
    Run(const OdometryOptions& options, const OdometryParams& params, std::ostream& err)
        : options_(options),
          guard_(guardOf(options)),
          source_(options, guard_),
          sinks_(openSinks(options)),
          keepFeatures_(std::any_of(
              sinks_.begin(), sinks_.end(), [](const auto& s) { return s->needsFeatures(); })),
          odometry_(params)
    {
        if (!options.mask.empty())
        {
            const cv::Mat mask = readMask(options.mask);
            maskSize_ = mask.size();
            leftOut_ = withoutRobot(mask) == 0;
            odometry_.setMask(mask);
        }
        odometry_.setMinLoggingLevel(mrpt::system::LVL_ERROR);  // the summary says it
        if (!options.quiet)
        {
            bar_.emplace(err, standardErrorIsTerminal(), options.inputs.front());
        }
    }

    [[nodiscard]] RunSummary run()
    {
        try
        {
            runFrames();
            bar_.reset();
            finish();
        }
        catch (const EnvironmentError&)
        {
            throw;  // what was written may be wanted
        }
        catch (const std::exception& e)
        {
            if (isOutOfMemory(e) || dynamic_cast<const std::system_error*>(&e) != nullptr)
            {
                throw;  // the machine, too
            }
            for (const auto& sink : sinks_)
            {
                sink->discard();
            }
            if (dynamic_cast<const InputError*>(&e) != nullptr)
            {
                throw;
            }
            throw std::logic_error(oneLine(e));  // a bug: the options are good by now
        }
        summary_.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - source_.start())
                .count();
        return std::move(summary_);
    }

 private:
    void runFrames()
    {
        if (options_.jobs > 1)
        {
            runThreads();
            return;
        }
        while (auto item = source_.next())
        {
            write(estimate(std::move(*item)));
        }
    }

    void runThreads()
    {
        constexpr std::size_t kDepth = 4;  // frames waiting between two threads
        BoundedQueue<SourceItem> read(kDepth);
        BoundedQueue<OutputItem> done(kDepth);
        Worker reader(
            [&]
            {
                const Closer closer{read};
                while (auto item = source_.next())
                {
                    if (!read.push(std::move(*item)))
                    {
                        return;
                    }
                }
            });
        const Closer endsReader{read};  // where there is no memory for another thread
        Worker writer(
            [&]
            {
                const Closer closer{done};  // a writer that fails stops the others
                while (auto item = done.pop())
                {
                    write(*item);
                }
            });
        const Closer endsWriter{done};
        Worker estimatorThread(
            [&]
            {
                const Closer closesOut{done};
                const Closer closesIn{read};
                while (auto item = read.pop())
                {
                    if (!done.push(estimate(std::move(*item))))
                    {
                        return;
                    }
                }
            });
        estimatorThread.join();
        reader.join();
        writer.join();
        writer.rethrow();
        estimatorThread.rethrow();
        reader.rethrow();
    }

    template <class T>
    struct Closer
    {
        BoundedQueue<T>& queue;
        ~Closer() { queue.close(); }
    };
    template <class T>
    Closer(BoundedQueue<T>&) -> Closer<T>;

    [[nodiscard]] OutputItem estimate(SourceItem source)
    {
        OutputItem item;
        item.source = std::move(source);
        if (!item.source.converted)
        {
            return item;
        }
        checkMask(item.source);
        FrameRecord& record = item.frame.emplace();
        record.motion = odometry_.process(*item.source.converted);
        if (summary_.numTracked == 0 && record.motion.status == TrackingStatus::Lost)
        {
            record.motion.reason += effectOfMask(item.source.converted->frame);
        }
        if (keepFeatures_)
        {
            record.features = odometry_.features();
        }
        summary_.add(item);
        if (bar_)
        {
            bar_->update(item.source.progress, summary_.numFrames);
        }
        return item;
    }

    /** By the first frame that has images; of those after it, the odometry says what is wrong. */
    void checkMask(const SourceItem& item)
    {
        const RgbdFrame& frame = item.converted->frame;
        if (!maskSize_.empty() && !frame.depth.empty())
        {
            requireMaskSize(
                options_.mask, maskSize_, frame.depth.size(), item.observation->sensorLabel);
            maskSize_ = {};
        }
    }

    /** What to add to the reason if a frame has enough depth, but not beside the robot. */
    [[nodiscard]] std::string effectOfMask(RgbdFrame frame) const
    {
        if (leftOut_.size() != frame.depth.size() || leftOut_.empty() || !hasDepth(frame))
        {
            return "";
        }
        frame.depth = frame.depth.clone();
        frame.depth.setTo(0, leftOut_);
        return hasDepth(frame) ? ""
                               : " (" + options_.mask + " leaves depth at " +
                                     std::to_string(cv::countNonZero(frame.depth > 0)) + " of " +
                                     std::to_string(frame.depth.total()) + " pixels)";
    }

    void write(const OutputItem& item)
    {
        for (const auto& sink : sinks_)
        {
            sink->add(item);
        }
    }

    void finish()
    {
        summary_.label = source_.label();
        summary_.damage = source_.damage();
        summary_.notes = source_.notes();
        requireFrames();
        for (const auto& sink : sinks_)
        {
            sink->close();
            summary_.outputs.push_back(sink->description());
        }
    }

    void requireFrames() const
    {
        if (summary_.numFrames > 0)
        {
            return;
        }
        if (!source_.damage().empty())
        {
            throw InputError(source_.damage());
        }
        const std::size_t numMore = options_.inputs.size() - 1;
        const std::string inputs =
            options_.inputs.front() +
            (numMore > 0 ? " and " + std::to_string(numMore) + " more: " : ": ");
        if (source_.framesOf().empty())
        {
            throw InputError(inputs + "no CObservation3DRangeScan in it");
        }
        std::string cameras;
        for (const auto& [label, count] : source_.framesOf())
        {
            cameras +=
                (cameras.empty() ? "" : ", ") + framesText(count) + " of camera '" + label + "'";
        }
        throw InputError(
            inputs +
            (source_.framesOf().count(source_.label()) > 0
                 ? "--first " + std::to_string(options_.first) + " skips all of them"
                 : "no frames of camera '" + source_.label() + "'") +
            "; in it are " + cameras);
    }

    const OdometryOptions& options_;
    OutputGuard guard_;
    FrameSource source_;
    Sinks sinks_;
    bool keepFeatures_;
    VisualOdometry odometry_;
    cv::Size maskSize_;  //!< until it is known to be that of the images
    cv::Mat leftOut_;    //!< by the mask
    std::optional<ProgressBar> bar_;
    RunSummary summary_;
};
}  // namespace

RunSummary runOdometry(
    const OdometryOptions& options, const OdometryParams& params, std::ostream& err)
{
    return Run(options, params, err).run();
}
}  // namespace pointplane
