// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
struct SequenceScores;

/** Accuracy of our configurations and of the peers on the same frames: every method gets each frame
 * in turn, so that a frame is read or rendered once and all are timed under the same load. */
class AccuracyBenchmark
{
 public:
    /** Adds the options to the command line. */
    explicit AccuracyBenchmark(CLI::App& app);

    /** Tables to `out`, progress to `err`, files as asked for.
     * \throws InputError, EnvironmentError; after all is written, IncompleteError */
    void run(std::ostream& out, std::ostream& err) const;

 private:
    [[nodiscard]] std::vector<SequenceScores> scoreAll(std::ostream& out, std::ostream& err) const;

    std::string data_, configDirectory_{"."}, jsonFile_, markdownFile_;
    std::vector<std::string> sequences_, methods_;
    double duration_{10};  //!< of simulated scenes [s]
    bool quick_{false};
};
}  // namespace pointplane
