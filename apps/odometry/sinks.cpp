// SPDX-License-Identifier: BSD-3-Clause
#include "sinks.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>

#include "OverlaySink.h"
#include "RawlogSink.h"
#include "map_sinks.h"
#include "text_sinks.h"

namespace pointplane
{
namespace
{
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
void addSinks(Sinks& sinks, const OdometryOptions& options)
{
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
}
}  // namespace

Sinks openSinks(const OdometryOptions& options)
{
    Sinks sinks;
    try
    {
        addSinks(sinks, options);
    }
    catch (...)
    {
        std::for_each(sinks.begin(), sinks.end(), [](const auto& sink) { sink->discard(); });
        throw;
    }
    return sinks;
}

OutputGuard guardOf(const OdometryOptions& options)
{
    OutputGuard guard;
    guard.addInput(options.config);
    guard.addInput(options.mask);
    for (const std::string& input : options.inputs)
    {
        guard.addInputRawlog(input);
    }
    guard.addText("--graph", options.graph);
    guard.addText("--trajectory", options.trajectory);
    guard.addText("--diagnostics", options.diagnostics);
    guard.addOutputFolder("--overlay", options.overlay, ".jpg");
    guard.addSimplemap("--simplemap", options.simplemap);
    guard.addRawlog("-o", options.output);
    return guard;
}
}  // namespace pointplane
