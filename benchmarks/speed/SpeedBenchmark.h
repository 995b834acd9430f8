// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
struct BenchmarkSequence;
class MarkdownGrid;

/** Time per frame of our configurations and of the peers on the same frames, in turn, image
 * decoding excluded: on one thread, on two, and where the time goes. */
class SpeedBenchmark
{
 public:
    /** Adds the options to the command line. */
    explicit SpeedBenchmark(CLI::App& app);

    /** Tables of each sequence to `out`, progress to `err`, and one over all sequences into a page
     * if asked for.
     * \throws InputError, EnvironmentError */
    void run(std::ostream& out, std::ostream& err) const;

 private:
    /** A sequence's table; a column of it into `times`. */
    [[nodiscard]] std::string wholeTable(
        const BenchmarkSequence& sequence, MarkdownGrid& times) const;
    /** A sequence's table; the first configuration's row into `shares`. */
    [[nodiscard]] std::string stageTable(
        const BenchmarkSequence& sequence, MarkdownGrid& shares) const;
    [[nodiscard]] std::size_t numFrames(const BenchmarkSequence& sequence) const;
    [[nodiscard]] std::string config(const std::string& name) const;

    std::string data_, configDirectory_{"."}, markdownFile_;
    std::size_t maxFrames_{0};
    bool oursAlone_{false};
};
}  // namespace pointplane
