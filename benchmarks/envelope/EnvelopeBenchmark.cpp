// SPDX-License-Identifier: BSD-3-Clause
#include "EnvelopeBenchmark.h"

#include <pointplane/core/quantile.h>
#include <pointplane/mrpt_io/errors.h>

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <ostream>
#include <regex>

#include "envelope_overview.h"
#include "envelope_tables.h"
#include "frame_changes.h"
#include "markdown_section.h"
#include "text_file.h"

namespace pointplane
{
namespace
{
constexpr double kUsualRate = 30;  //!< [Hz]: it has every condition that any rate has

/** Calls work(0) .. work(n - 1), any of them at the same time as others. */
void forEachOf(std::size_t n, unsigned int jobs, const std::function<void(std::size_t)>& work)
{
    std::atomic<std::size_t> next{0};
    const auto worker = [&]
    {
        for (std::size_t k = next++; k < n; k = next++)
        {
            work(k);
        }
    };
    std::vector<std::future<void>> workers;
    for (unsigned int i = 0; i < jobs; ++i)
    {
        workers.push_back(std::async(std::launch::async, worker));
    }
    std::for_each(workers.begin(), workers.end(), [](auto& w) { w.get(); });
}

/** What one method made of one run. */
struct RunResult
{
    std::vector<double> stamps;
    std::vector<MethodStep> steps;
    std::string failure;
};

/** A peer gets no frame that shows nothing: it keeps its motion, and is lost. */
[[nodiscard]] MethodStep stepOf(
    Method& method, bool isPeer, const RgbdFrame& frame, const RunResult& soFar)
{
    if (isPeer && !showsSomething(frame))
    {
        MethodStep out;
        out.outcome = Outcome::Lost;
        out.T_prev_cur = soFar.steps.empty() ? out.T_prev_cur : soFar.steps.back().T_prev_cur;
        return out;
    }
    return method.process(frame);
}

[[nodiscard]] RunResult resultOf(
    const NamedMethod& named, const EnvelopeRun& run, const std::vector<RgbdFrame>& frames)
{
    RunResult out;
    try
    {
        const std::unique_ptr<Method> method = named.create();
        for (const FrameUse& use : run)
        {
            RgbdFrame frame = frames[use.shown];
            frame.stamp = frames[use.at].stamp;
            frame = use.change ? use.change(frame) : frame;
            MethodStep step = stepOf(*method, named.isPeer, frame, out);
            step.since.clear();
            out.stamps.push_back(frame.stamp);
            out.steps.push_back(std::move(step));
        }
    }
    catch (const std::exception& error)
    {
        // One method that gives up must not take the others' results with it.
        out.failure = oneLine(error);
    }
    return out;
}

[[nodiscard]] std::vector<RgbdFrame> allFrames(const BenchmarkSequence& sequence, unsigned int jobs)
{
    std::vector<RgbdFrame> out(sequence.numFrames);
    forEachOf(out.size(), jobs, [&](std::size_t k) { out[k] = sequence.frame(k); });
    return out;
}

/** Frames per second. */
[[nodiscard]] double rateOf(const std::vector<RgbdFrame>& frames)
{
    std::vector<double> steps;
    for (std::size_t k = 1; k < frames.size(); ++k)
    {
        steps.push_back(frames[k].stamp - frames[k - 1].stamp);
    }
    return 1 / median(std::move(steps));
}

[[nodiscard]] std::regex regexOf(const std::string& text)
{
    try
    {
        return std::regex(text);
    }
    catch (const std::regex_error&)
    {
        throw InputError("--only " + text + ": is not a regular expression");
    }
}

[[nodiscard]] std::string cellName(const std::string& sequence, const std::string& condition)
{
    return sequence + ", " + condition;
}
}  // namespace

EnvelopeBenchmark::EnvelopeBenchmark(CLI::App& app)
{
    app.add_option("--data", data_, "folder with TUM sequences; without it only simulated scenes")
        ->envname("POINTPLANE_DATA");
    app.add_option("--config-directory", configDirectory_, "with config.ini and its relatives")
        ->capture_default_str();
    app.add_option(
           "--configs", configs_, "files in it, the first is the table's; 'none': only peers")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--set", settings_, "Section.key=value for all of them, any number of times")
        ->expected(1)
        ->take_all();
    app.add_option(
        "--only", only_, "regular expression: only cells with a part of 'SEQUENCE, CONDITION'");
    app.add_flag(
        "--peers",
        peers_,
        "also OpenCV's RgbdOdometry and RgbdICPOdometry and MRPT's DIFODO, where there is truth "
        "(slow)");
    app.add_flag("--quick", quick_, "fewer conditions, places and scenes: two minutes");
    app.add_option("--places", places_, "of each gap in a sequence, at most")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--phases", phases_, "of each rate: starting frames, at most")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--duration", duration_, "of simulated scenes [s]")
        ->capture_default_str()
        ->check(CLI::Range(2.0, 600.0));
    app.add_option("--jobs", jobs_, "runs at the same time; the figures do not depend on it")
        ->capture_default_str()
        ->check(CLI::Range(1U, 64U));
    app.add_flag("--details", details_, "print every cell, a table per sequence");
    app.add_option("--csv", csvFile_, "write a line per sequence, condition and method");
    app.add_option(
        "--add",
        addedFile_,
        "show what an earlier run's --csv has of other methods, too: peers do not change");
    app.add_option("--failures", failuresFile_, "write the tracked steps that are wrong (CSV)");
    app.add_option("--markdown", markdownFile_, "replace a section of this page");
    app.add_option("--section", section_, "which one")->capture_default_str();
}

ConditionOptions EnvelopeBenchmark::conditionOptions() const
{
    ConditionOptions out;
    out.places = places_;
    out.phases = phases_;
    if (quick_)
    {
        out.rates = {30, 15, 10, 6, 3, 2};
        out.gaps = {6, 15, 50};
        out.frozen = {15};
        out.places = std::min(3, places_);
        out.phases = std::min(2, phases_);
    }
    return out;
}

std::vector<SequenceSource> EnvelopeBenchmark::sources() const
{
    std::vector<SequenceSource> out =
        data_.empty() ? std::vector<SequenceSource>() : recordedSequences(data_);
    const double seconds = quick_ ? std::min(duration_, 3.0) : duration_;
    for (auto& scenes : {simulatedSequences(seconds), hardSimulatedSequences(seconds)})
    {
        out.insert(out.end(), scenes.begin(), scenes.end());
    }
    const std::regex rest(
        "simulated (corner|cabinet.*|corridor|.*(twice as fast|blurred|without .*|from .*)|"
        "notexture .*)");
    const auto isLeftOut = [&](const SequenceSource& source)
    { return (quick_ && std::regex_match(source.name, rest)) || !mayBeWanted(source); };
    out.erase(std::remove_if(out.begin(), out.end(), isLeftOut), out.end());
    return out;
}

std::vector<NamedMethod> EnvelopeBenchmark::methods() const
{
    std::vector<NamedMethod> out;
    for (const std::string& config : configs_)
    {
        if (config == "none")
        {
            continue;
        }
        std::vector<std::string> settings = settings_;
        settings.emplace_back("Pipeline.numThreads=1");
        out.push_back(ourMethod(config, configDirectory_ + "/" + config, settings));
    }
    if (peers_)
    {
        out.push_back(openCvMethod("RgbdOdometry"));
        out.push_back(openCvMethod("RgbdICPOdometry"));
        out.push_back(difodoMethod(160));
    }
    return out;
}

bool EnvelopeBenchmark::isWanted(const std::string& cell) const
{
    return std::regex_search(cell, regexOf(only_));
}

/** Opening a sequence costs seconds: is there a condition at all that is wanted of it? */
bool EnvelopeBenchmark::mayBeWanted(const SequenceSource& source) const
{
    constexpr std::size_t kManyFrames = 1000;
    const auto all = envelopeConditions(kManyFrames, kUsualRate, conditionOptions());
    return std::any_of(
        all.begin(),
        all.end(),
        [&](const Condition& condition)
        { return isWanted(cellName(source.name, condition.name)); });
}

std::vector<Condition> EnvelopeBenchmark::conditionsOf(
    const BenchmarkSequence& sequence, double rate) const
{
    std::vector<Condition> out = envelopeConditions(sequence.numFrames, rate, conditionOptions());
    if (sequence.isHardAlready)
    {
        out.resize(std::min<std::size_t>(out.size(), 1));  // at its own rate
    }
    const auto isLeftOut = [&](const Condition& condition)
    { return !isWanted(cellName(sequence.name, condition.name)); };
    out.erase(std::remove_if(out.begin(), out.end(), isLeftOut), out.end());
    return out;
}

std::vector<EnvelopeScore> EnvelopeBenchmark::scoreSequence(
    const BenchmarkSequence& sequence,
    const std::vector<NamedMethod>& allMethods,
    std::ostream& err) const
{
    std::vector<NamedMethod> methods = allMethods;
    if (sequence.kind == Truth::None)
    {
        const auto isPeer = [](const NamedMethod& method) { return method.isPeer; };
        methods.erase(std::remove_if(methods.begin(), methods.end(), isPeer), methods.end());
    }
    if (conditionsOf(sequence, kUsualRate).empty())
    {
        return {};  // before all of its frames are read
    }
    const std::vector<RgbdFrame> frames = allFrames(sequence, jobs_);
    struct Job
    {
        std::size_t score, run;
    };
    const std::vector<Condition> conditions = conditionsOf(sequence, rateOf(frames));
    std::vector<Job> work;
    for (std::size_t c = 0; c < conditions.size(); ++c)
    {
        for (std::size_t m = 0; m < methods.size(); ++m)
        {
            for (std::size_t r = 0; r < conditions[c].runs.size(); ++r)
            {
                work.push_back({c * methods.size() + m, r});
            }
        }
    }
    std::vector<RunResult> results(work.size());
    std::atomic<std::size_t> done{0};
    forEachOf(
        work.size(),
        jobs_,
        [&](std::size_t k)
        {
            const auto [score, run] = work[k];
            const Condition& condition = conditions[score / methods.size()];
            results[k] = resultOf(methods[score % methods.size()], condition.runs[run], frames);
            const std::size_t count = ++done;
            if (count * 10 / work.size() != (count - 1) * 10 / work.size())
            {
                err << sequence.name + ": " + std::to_string(count * 100 / work.size()) + " %\n"
                    << std::flush;
            }
        });
    std::vector<EnvelopeScore> out;
    for (std::size_t k = 0; k < work.size();)
    {
        const std::size_t index = work[k].score;
        EnvelopeScore names;
        names.sequence = sequence.name;
        names.condition = conditions[index / methods.size()].name;
        names.method = methods[index % methods.size()].name;
        names.isPeer = methods[index % methods.size()].isPeer;
        EnvelopeScorer scorer(sequence);
        for (; k < work.size() && work[k].score == index; ++k)
        {
            names.failure = names.failure.empty() ? results[k].failure : names.failure;
            if (results[k].failure.empty())
            {
                scorer.add(results[k].stamps, results[k].steps);
            }
        }
        out.push_back(scorer.score(std::move(names)));
    }
    return out;
}

void EnvelopeBenchmark::run(std::ostream& out, std::ostream& err) const
{
    cv::setNumThreads(1);  // runs are independent: the machine is better used by these
    if (!markdownFile_.empty())
    {
        checkMarkdownSection(markdownFile_, section_);
    }
    const std::vector<NamedMethod> wanted = methods();
    std::vector<EnvelopeScore> all;
    for (const SequenceSource& source : sources())
    {
        std::vector<EnvelopeScore> scores = scoreSequence(source.open(), wanted, err);
        if (details_ && !scores.empty())
        {
            out << envelopeTables(scores) << std::endl;
        }
        std::move(scores.begin(), scores.end(), std::back_inserter(all));
    }
    if (all.empty())
    {
        throw InputError("--only " + only_ + ": matches no 'SEQUENCE, CONDITION'");
    }
    if (!addedFile_.empty())
    {
        all = withMethodsOf(all, scoresFromCsv(addedFile_));
    }
    const std::string page = "\n" + envelopeSummary(all) + envelopeOverview(all) + "\n";
    out << page;
    if (!csvFile_.empty())
    {
        writeTextFile(csvFile_, envelopeCsv(all));
    }
    if (!failuresFile_.empty())
    {
        writeTextFile(failuresFile_, failuresCsv(all));
    }
    if (!markdownFile_.empty())
    {
        replaceMarkdownSection(markdownFile_, section_, page);
    }
    requireNoFailures(all);
}
}  // namespace pointplane
