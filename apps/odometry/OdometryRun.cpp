// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryRun.h"

#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "FrameSource.h"
#include "ProgressBar.h"
#include "RobotMask.h"
#include "run_in_threads.h"
#include "sinks.h"

namespace pointplane
{
namespace
{
/** The run, in one thread or in three. */
class Run
{
 public:
    Run(const OdometryOptions& options, const OdometryParams& params, std::ostream& err)
        : options_(options),
          guard_(guardOf(options)),
          source_(options, guard_),
          mask_(options.mask),
          sinks_(openSinks(options)),
          keepFeatures_(std::any_of(
              sinks_.begin(), sinks_.end(), [](const auto& s) { return s->needsFeatures(); })),
          odometry_(params)
    {
        if (!options.mask.empty())
        {
            odometry_.setMask(mask_.image());
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
        const auto read = [this] { return source_.next(); };
        const auto estimate = [this](SourceItem item) { return estimated(std::move(item)); };
        const auto write = [this](const OutputItem& item)
        {
            for (const auto& sink : sinks_)
            {
                sink->add(item);
            }
        };
        if (options_.jobs > 1)
        {
            runInThreads(read, estimate, write);
            return;
        }
        while (auto item = read())
        {
            write(estimate(std::move(*item)));
        }
    }

    [[nodiscard]] OutputItem estimated(SourceItem source)
    {
        OutputItem item;
        item.source = std::move(source);
        if (!item.source.converted)
        {
            return item;
        }
        mask_.requireFit(item.source);
        FrameRecord& record = item.frame.emplace();
        record.motion = odometry_.process(*item.source.converted);
        if (summary_.numTracked == 0 && record.motion.status == TrackingStatus::Lost)
        {
            record.motion.reason += mask_.effectOn(item.source.converted->frame);
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

    void finish()
    {
        summary_.label = source_.label();
        summary_.damage = source_.damage();
        summary_.notes = source_.notes();
        if (summary_.numFrames == 0)
        {
            throw InputError(source_.whyNoFrames());
        }
        for (const auto& sink : sinks_)
        {
            sink->close();
            summary_.outputs.push_back(sink->description());
        }
    }

    const OdometryOptions& options_;
    OutputGuard guard_;
    FrameSource source_;
    RobotMask mask_;
    Sinks sinks_;  // after all inputs: what is wrong with those leaves no file behind
    bool keepFeatures_;
    VisualOdometry odometry_;
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
