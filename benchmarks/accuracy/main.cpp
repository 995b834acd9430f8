// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "methods.h"
#include "sequences.h"
#include <CLI/CLI.hpp>

namespace
{
using namespace pointplane;

struct Run
{
    Trajectory estimate;
    int lost{0}, predicted{0};
    std::vector<double> ms;
};

[[nodiscard]] Run run(const BenchmarkSequence& sequence, Method& method, std::size_t numFrames)
{
    Run out;
    out.estimate.name = "estimate";
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t k = 0; k < numFrames; ++k)
    {
        const RgbdFrame frame = sequence.frame(k);
        const auto start = std::chrono::steady_clock::now();
        const MethodStep step = method.process(frame);
        out.ms.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
        pose = pose * step.T_prev_cur;
        out.lost += step.outcome == Outcome::Lost ? 1 : 0;
        out.predicted += step.outcome == Outcome::Predicted ? 1 : 0;
        out.estimate.stamps.push_back(frame.stamp);
        out.estimate.poses.push_back(step.pose ? step.pose->mean : pose);
        if (step.pose)
        {
            out.estimate.covs.push_back(step.pose->cov);
        }
    }
    std::sort(out.ms.begin(), out.ms.end());
    return out;
}

/** NEES per degree of freedom, or a dash. */
[[nodiscard]] std::string nees(
    const Trajectory& truth, const Trajectory& estimate, const char* name)
{
    if (estimate.covs.empty())
    {
        return "-";
    }
    const NeesInterval interval = neesIntervalFromName(name);
    try
    {
        const auto increments = neesIncrements(truth, estimate, interval, {});
        const auto result = consistencyOf(increments, countIndependent(increments), interval);
        char text[32];
        std::snprintf(text, sizeof(text), "%.2f", result.joint.nees);
        return text;
    }
    catch (const std::runtime_error&)
    {
        return "-";  // fewer increments than it takes
    }
}

[[nodiscard]] std::string row(const std::string& method, const Trajectory& truth, const Run& r)
{
    RpeOptions options;
    options.fixedDelta = true;
    const RpeResult rpe = relativePoseError(truth, r.estimate, options);
    const AteResult ate = absoluteTrajectoryError(truth, r.estimate, {});
    char text[512];
    std::snprintf(
        text,
        sizeof(text),
        "| %s | %.1f | %.2f | %.1f | %d / %d | %.1f | %.1f | %s | %s | %s |",
        method.c_str(),
        1e3 * rpe.translation.rmse,
        rpe.rotation.rmse * 180 / M_PI,
        1e3 * ate.translation.rmse,
        r.lost,
        r.predicted,
        r.ms[r.ms.size() / 2],
        r.ms[r.ms.size() * 99 / 100],
        nees(truth, r.estimate, "1f").c_str(),
        nees(truth, r.estimate, "10f").c_str(),
        nees(truth, r.estimate, "1s").c_str());
    return text;
}

/** Nothing or several comma separated parts of the name asked for. */
[[nodiscard]] bool wanted(const std::string& name, const std::vector<std::string>& filter)
{
    return filter.empty() || std::any_of(
                                 filter.begin(),
                                 filter.end(),
                                 [&](const auto& f) { return name.find(f) != std::string::npos; });
}

struct Options
{
    std::string data, configDirectory{"."};
    std::vector<std::string> sequences, methods;
    std::size_t numFrames{0};
    double duration{6};
};

void runAll(const Options& options)
{
    auto sequences =
        options.data.empty() ? std::vector<BenchmarkSequence>{} : tumSequences(options.data);
    for (auto& s : simulatedSequences(options.duration))
    {
        sequences.push_back(std::move(s));
    }
    auto methods = ourMethods(options.configDirectory);
    for (auto& m : peerMethods())
    {
        methods.push_back(std::move(m));
    }
    for (const auto& sequence : sequences)
    {
        if (!wanted(sequence.name, options.sequences))
        {
            continue;
        }
        const std::size_t n = options.numFrames == 0
                                  ? sequence.numFrames
                                  : std::min(options.numFrames, sequence.numFrames);
        std::cout << "\n### " << sequence.name << " (" << n << " frames)\n\n"
                  << "| method | RPE mm/s | RPE deg/s | ATE mm | lost / predicted | ms median | "
                     "ms p99 | NEES/dof 1 frame | 10 frames | 1 s |\n"
                     "|---|---|---|---|---|---|---|---|---|---|\n";
        for (const auto& method : methods)
        {
            if (wanted(method.name, options.methods))
            {
                try
                {
                    std::cout << row(method.name,
                                     sequence.truth,
                                     run(sequence, *method.create(), n))
                              << std::endl;
                }
                catch (const std::exception& error)
                {
                    // One peer that gives up must not take the others' rows with it.
                    const std::string what = error.what();
                    std::cout << "| " << method.name
                              << " | failed: " << what.substr(0, what.find('\n'))
                              << " | | | | | | | | |" << std::endl;
                }
            }
        }
    }
}
}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Accuracy of our configurations and of the peers that Debian ships, as Markdown"};
    Options options;
    const char* data = std::getenv("POINTPLANE_DATA");
    options.data = data != nullptr ? data : "";
    app.add_option("--configs", options.configDirectory, "folder of config.ini, config-paper.ini");
    app.add_option("--sequences", options.sequences, "parts of names")->delimiter(',');
    app.add_option("--methods", options.methods, "parts of names")->delimiter(',');
    app.add_option("--frames", options.numFrames, "of each sequence at most; 0 = all");
    app.add_option("--duration", options.duration, "of simulated sequences [s]");
    CLI11_PARSE(app, argc, argv);
    try
    {
        runAll(options);
        return kExitOk;
    }
    catch (const std::exception& e)
    {
        std::cerr << "benchmark_accuracy: " << oneLine(e) << "\n";
        return kExitBadInput;
    }
}
