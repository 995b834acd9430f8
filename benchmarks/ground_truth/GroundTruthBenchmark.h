// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
struct SequenceSource;
class TruthRotationNoise;

/** Rotational noise of the ground truth of sequences, from pairs of images some frames apart. White
 * noise is the same at any distance; what grows with it is something else. */
class GroundTruthBenchmark
{
 public:
    /** Adds the options to the command line. */
    explicit GroundTruthBenchmark(CLI::App& app);

    /** Table to `out`, progress to `err`, file as asked for. \throws InputError, EnvironmentError
     */
    void run(std::ostream& out, std::ostream& err) const;

 private:
    [[nodiscard]] std::vector<TruthRotationNoise> measure(
        const SequenceSource& source, std::ostream& err) const;

    std::string data_, csvFile_;
    std::vector<std::string> sequences_;
    std::vector<std::size_t> distances_{1, 10, 30};  //!< [frames]
    double duration_{5};                             //!< of simulated scenes [s]
};
}  // namespace pointplane
