// SPDX-License-Identifier: BSD-3-Clause
#include "SpeedBenchmark.h"

#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>
#include <pointplane/planes/PlaneExtractor.h>

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <ostream>
#include <sstream>
#include <utility>

#include "FrameTimes.h"
#include "MarkdownGrid.h"
#include "markdown_section.h"
#include "methods.h"
#include "sequences.h"

namespace pointplane
{
namespace
{
const char* const kConfigs[] = {"config.ini", "config-fast.ini", "config-paper.ini"};

/** One odometry, once on one thread and once on two. */
struct Contender
{
    std::string name;
    std::unique_ptr<Method> oneThread, twoThreads;
    FrameTimes cpu, wall;
};

[[nodiscard]] Contender contender(const NamedMethod& one, const NamedMethod& two)
{
    return {one.name, one.create(), two.create(), {}, {}};
}

[[nodiscard]] std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

[[nodiscard]] const Contender& named(const std::vector<Contender>& all, const std::string& name)
{
    return *std::find_if(
        all.begin(), all.end(), [&](const Contender& c) { return c.name == name; });
}
}  // namespace

SpeedBenchmark::SpeedBenchmark(CLI::App& app)
{
    app.add_option("--data", data_, "folder with TUM sequences")
        ->envname("POINTPLANE_DATA")
        ->required();
    app.add_option("--config-directory", configDirectory_, "with config.ini and its relatives")
        ->capture_default_str();
    app.add_option("--frames", maxFrames_, "of each sequence, at most; 0 = all")
        ->capture_default_str();
    app.add_flag("--ours", oursAlone_, "leave the peers out");
    app.add_option("--markdown", markdownFile_, "also replace the section `speed` of this page");
}

std::string SpeedBenchmark::config(const std::string& name) const
{
    return configDirectory_ + "/" + name;
}

std::size_t SpeedBenchmark::numFrames(const BenchmarkSequence& sequence) const
{
    return maxFrames_ == 0 ? sequence.numFrames : std::min(maxFrames_, sequence.numFrames);
}

std::string SpeedBenchmark::wholeTable(const BenchmarkSequence& sequence, MarkdownGrid& times) const
{
    std::vector<Contender> all;
    for (const char* name : kConfigs)
    {
        all.push_back(contender(
            ourMethod(name, config(name), {"Pipeline.numThreads=1"}),
            ourMethod(name, config(name), {"Pipeline.numThreads=2"})));
    }
    for (const NamedMethod& peer : oursAlone_ ? std::vector<NamedMethod>{} : peerMethods())
    {
        all.push_back(contender(peer, peer));
    }
    for (std::size_t k = 0; k < numFrames(sequence); ++k)
    {
        const RgbdFrame frame = sequence.frame(k);
        for (Contender& c : all)
        {
            cv::setNumThreads(1);
            c.cpu.addCpu([&] { (void)c.oneThread->process(frame); });
            cv::setNumThreads(2);
            c.wall.addWall([&] { (void)c.twoThreads->process(frame); });
        }
    }
    for (const Contender& c : all)
    {
        times.add(c.name, sequence.name, number(c.cpu.median()) + " / " + number(c.cpu.p99()));
    }
    for (std::size_t i = 0; i < std::size(kConfigs); ++i)
    {
        const FrameTimes& wall = all[i].wall;
        const std::string text = number(wall.median()) + " / " + number(wall.p99());
        times.add(all[i].name + ", two threads", sequence.name, text);
    }
    std::ostringstream out;
    out << "| method | one thread, median ms | p99 | two threads, median ms | p99 |"
        << (oursAlone_ ? "\n" : " times RgbdICP | times Rgbd |\n") << "|---|---|---|---|---|"
        << (oursAlone_ ? "\n" : "---|---|\n");
    for (const Contender& c : all)
    {
        out << "| " << c.name << " | " << number(c.cpu.median()) << " | " << number(c.cpu.p99())
            << " | " << number(c.wall.median()) << " | " << number(c.wall.p99()) << " |";
        for (const char* peer : {"OpenCV RgbdICPOdometry", "OpenCV RgbdOdometry"})
        {
            if (!oursAlone_)
            {
                out << ' ' << number(named(all, peer).cpu.median() / c.cpu.median()) << " |";
            }
        }
        out << '\n';
    }
    return out.str();
}

std::string SpeedBenchmark::stageTable(
    const BenchmarkSequence& sequence, MarkdownGrid& shares) const
{
    struct Stages
    {
        std::unique_ptr<Odometry> odometry;
        FrameTimes points, planes, matching, pose, rest, total;
    };
    static const std::pair<const char*, FrameTimes Stages::*> kStages[] = {
        {"pyramid or key points", &Stages::points},
        {"planes", &Stages::planes},
        {"matching and tracking", &Stages::matching},
        {"pose", &Stages::pose},
        {"references and the rest", &Stages::rest}};
    cv::setNumThreads(1);
    Stages all[std::size(kConfigs)];
    for (std::size_t i = 0; i < std::size(kConfigs); ++i)
    {
        all[i].odometry = std::make_unique<Odometry>(loadOdometryParams(config(kConfigs[i])));
    }
    PlaneExtractor extractor({}, {});
    FrameTimes extraction;
    for (std::size_t k = 0; k < numFrames(sequence); ++k)
    {
        const RgbdFrame frame = sequence.frame(k);
        for (Stages& s : all)
        {
            const FrameDiagnostics d = s.odometry->process(frame).diagnostics;
            s.points.add(d.msPoints);
            s.planes.add(d.msPlanes);
            s.matching.add(d.msMatching);
            s.pose.add(d.msPose);
            s.rest.add(d.msTotal - d.msPoints - d.msPlanes - d.msMatching - d.msPose);
            s.total.add(d.msTotal);
        }
        extraction.addCpu([&] { (void)extractor.extract(frame.depth, frame.camera); });
    }
    std::ostringstream out;
    out << "| share of the mean time, % |";
    for (const auto& [name, times] : kStages)
    {
        out << ' ' << name << " |";
    }
    out << "\n|---|---|---|---|---|---|\n";
    for (std::size_t i = 0; i < std::size(kConfigs); ++i)
    {
        const Stages& s = all[i];
        out << "| " << kConfigs[i];
        for (const auto& [name, times] : kStages)
        {
            const long share = std::lround(100 * (s.*times).mean() / s.total.mean());
            out << " | " << share;
            if (i == 0)
            {
                shares.add(sequence.name, name, std::to_string(share));
            }
        }
        out << " |\n";
    }
    out << "\nPlane extraction with fit and covariance: median " << number(extraction.median())
        << " ms, p99 " << number(extraction.p99()) << " ms.\n";
    return out.str();
}

void SpeedBenchmark::run(std::ostream& out, std::ostream& err) const
{
    if (!markdownFile_.empty())
    {
        checkMarkdownSection(markdownFile_, "speed");
    }
    MarkdownGrid times, shares;
    for (const SequenceSource& source : tumSequences(data_))
    {
        const BenchmarkSequence sequence = source.open();
        err << source.name << " (" << numFrames(sequence) << " frames)\n";
        out << "### " << source.name << " (" << numFrames(sequence) << " frames)\n\n"
            << wholeTable(sequence, times) << "\n";
        out << stageTable(sequence, shares) << "\n" << std::flush;
    }
    if (!markdownFile_.empty())
    {
        const std::string page = "\nMilliseconds, median / 99th percentile:\n\n" +
                                 times.markdown("method") + "\nStages of " + kConfigs[0] +
                                 ", % of the mean time:\n\n" + shares.markdown("sequence") + "\n";
        replaceMarkdownSection(markdownFile_, "speed", page);
    }
}
}  // namespace pointplane
