// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "EnvelopeScore.h"
#include "conditions.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
/** What becomes of our configurations, and of the peers, when recordings are slow, interrupted or
 * poor: every sequence under every condition, each run of it with an odometry that starts anew. */
class EnvelopeBenchmark
{
 public:
    /** Adds the options to the command line. */
    explicit EnvelopeBenchmark(CLI::App& app);

    /** Tables to `out`, progress to `err`, files as asked for.
     * \throws InputError, EnvironmentError; after all is written, IncompleteError */
    void run(std::ostream& out, std::ostream& err) const;

 private:
    [[nodiscard]] ConditionOptions conditionOptions() const;
    [[nodiscard]] std::vector<SequenceSource> sources() const;
    [[nodiscard]] std::vector<NamedMethod> methods() const;
    [[nodiscard]] bool isWanted(const std::string& cell) const;
    [[nodiscard]] bool mayBeWanted(const SequenceSource& source) const;
    [[nodiscard]] std::vector<Condition> conditionsOf(
        const BenchmarkSequence& sequence, double rate) const;
    [[nodiscard]] std::vector<EnvelopeScore> scoreSequence(
        const BenchmarkSequence& sequence,
        const std::vector<NamedMethod>& methods,
        std::ostream& err) const;

    std::string data_, configDirectory_{"."}, only_, csvFile_, addedFile_, failuresFile_;
    std::string markdownFile_, section_{"envelope"};
    std::vector<std::string> configs_{"config.ini"}, settings_;
    double duration_{4};  //!< of simulated scenes [s]
    int places_{10}, phases_{30};
    unsigned int jobs_{1};
    bool quick_{false}, peers_{false}, details_{false};
};
}  // namespace pointplane
