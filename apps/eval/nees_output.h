// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/coverage.h>
#include <pointplane/evaluation/nees.h>

#include "result_output.h"

namespace pointplane
{
/** What `nees` found, with all that is needed to repeat it. */
struct NeesReport
{
    std::vector<std::string> files;  //!< ground truth and estimate in turns
    NeesOptions options;
    std::vector<NeesResult> results;  //!< one per interval
    std::vector<Coverage> coverages;  //!< one per run
    std::string saved;                //!< lines of --save
};

/** Lines of --save: error, sigma and NEES of each increment. \param file of the estimate */
[[nodiscard]] std::string savedIncrements(
    const std::string& file, const Trajectory& estimate, const NeesRun& run);

/** "sigma 0.0001 m and 0.06 deg per axis and pose", or the three angles. */
[[nodiscard]] std::string describeTruthNoise(const NeesOptions& options);
[[nodiscard]] std::string describe(const NeesReport& report);
void printTable(const NeesReport& report, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json toJson(const NeesReport& report);
[[nodiscard]] std::string toCsv(const NeesReport& report);

/** Writes table, JSON and CSV as asked for; throws EnvironmentError. */
void writeReport(const NeesReport& report, const OutputFiles& files, std::ostream& out);
}  // namespace pointplane
