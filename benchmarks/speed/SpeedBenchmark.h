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

/** Time per frame of our configurations and of the peers on the same frames, in turn, image
 * decoding excluded: on one thread, on two, and where the time goes. */
class SpeedBenchmark
{
 public:
    /** Adds the options to the command line. */
    explicit SpeedBenchmark(CLI::App& app);

    /** Tables to `out`, progress to `err`, and into a page if asked for.
     * \throws InputError, EnvironmentError */
    void run(std::ostream& out, std::ostream& err) const;

 private:
    [[nodiscard]] std::string wholeTable(const BenchmarkSequence& sequence) const;
    [[nodiscard]] std::string stageTable(const BenchmarkSequence& sequence) const;
    [[nodiscard]] std::size_t numFrames(const BenchmarkSequence& sequence) const;
    [[nodiscard]] std::string config(const std::string& name) const;

    std::string data_, configDirectory_{"."}, markdownFile_;
    std::size_t maxFrames_{0};
    bool oursAlone_{false};
};
}  // namespace pointplane
