// SPDX-License-Identifier: BSD-3-Clause
#include "AccuracyBenchmark.h"

#include <algorithm>
#include <ostream>

#include "MethodRun.h"
#include "accuracy_tables.h"
#include "markdown_section.h"
#include "selection.h"
#include "text_file.h"

namespace pointplane
{
namespace
{
constexpr std::size_t kQuickFrames = 75;
constexpr std::size_t kProgressStep = 50;  //!< frames
}  // namespace

AccuracyBenchmark::AccuracyBenchmark(CLI::App& app)
{
    app.add_option("--data", data_, "folder with TUM sequences; without it only simulated scenes")
        ->envname("POINTPLANE_DATA");
    app.add_option("--config-directory", configDirectory_, "with config.ini and its relatives")
        ->capture_default_str();
    app.add_option("--sequences", sequences_, "only those with one of these in their name")
        ->delimiter(',');
    app.add_option("--methods", methods_, "likewise")->delimiter(',');
    app.add_option("--duration", duration_, "of simulated scenes [s]")
        ->capture_default_str()
        ->check(CLI::Range(2.0, 600.0));
    app.add_flag("--quick", quick_, "only the first 75 frames of each sequence");
    app.add_option("--json", jsonFile_, "also write all scores to this file");
    app.add_option("--markdown", markdownFile_, "also replace the section `accuracy` of this page");
}

std::vector<SequenceScores> AccuracyBenchmark::scoreAll(std::ostream& out, std::ostream& err) const
{
    const std::vector<SequenceSource> sources =
        wantedOf(allSequences(data_, duration_), sequences_, "--sequences");
    std::vector<NamedMethod> methods = ourMethods(configDirectory_);
    for (NamedMethod& peer : peerMethods())
    {
        methods.push_back(std::move(peer));
    }
    methods = wantedOf(std::move(methods), methods_, "--methods");

    std::vector<SequenceScores> all;
    for (const SequenceSource& source : sources)
    {
        const BenchmarkSequence sequence = source.open();
        std::vector<MethodRun> runs(methods.begin(), methods.end());
        const std::size_t n =
            quick_ ? std::min(kQuickFrames, sequence.numFrames) : sequence.numFrames;
        for (std::size_t k = 0; k < n; ++k)
        {
            const RgbdFrame frame = sequence.frame(k);
            std::for_each(runs.begin(), runs.end(), [&](MethodRun& r) { r.process(frame); });
            if ((k + 1) % kProgressStep == 0 || k + 1 == n)
            {
                err << source.name << ": frame " << k + 1 << " of " << n << "\n";
            }
        }
        SequenceScores scores{source.name, {}};
        for (const MethodRun& r : runs)
        {
            scores.methods.push_back(r.score(sequence));
        }
        out << markdownTable(scores) << std::endl;
        all.push_back(std::move(scores));
    }
    return all;
}

void AccuracyBenchmark::run(std::ostream& out, std::ostream& err) const
{
    if (!markdownFile_.empty())
    {
        checkMarkdownSection(markdownFile_, "accuracy");
    }
    const std::vector<SequenceScores> all = scoreAll(out, err);
    if (!jsonFile_.empty())
    {
        writeTextFile(jsonFile_, toJson(all).dump(2) + "\n");
    }
    if (!markdownFile_.empty())
    {
        const std::string text = "\n" + markdownSummary(all) + markdownOverview(all);
        replaceMarkdownSection(markdownFile_, "accuracy", text + "\n");
    }
    requireNoFailures(all);
}
}  // namespace pointplane
