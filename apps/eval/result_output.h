// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/coverage.h>

#include <iosfwd>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace pointplane
{
struct CommandContext;
class OutputGuard;

/** One line of a result table. */
struct StatisticsRow
{
    std::string name;  //!< "translation"
    std::string unit;  //!< "m"
    Statistics statistics;
};

/** A result with its title, ready for every form of output. */
struct ScoredResult
{
    std::string title;     //!< "Relative pose error"
    std::string protocol;  //!< one line: all that is needed to repeat it
    std::string coverage;  //!< one line: how much was scored
    std::string groundTruth, estimate;
    std::vector<StatisticsRow> rows;
    nlohmann::ordered_json details;  //!< further members of the JSON object
    std::string singles;             //!< the errors one by one, CSV
};

/** Options --json, --csv and --save FILE ("-" is the standard output, and replaces the table). */
struct OutputFiles
{
    std::string json, csv, save;
    /** \param single what --save writes a line of, e.g. "pair"; empty: there is no --save */
    void addTo(CLI::App& command, const std::string& single);
    /** Tells the guard what will be written.
     * \param lines the command itself prints more than the table that these replace (--verbose)
     * \throws InputError if two of them are the standard output, EnvironmentError if one or the
     * table alone is, and it is closed */
    void guardedBy(OutputGuard& guard, bool lines = false) const;
    /** Whether one of them is the standard output, by "-" or by a name like /dev/stdout. */
    [[nodiscard]] bool replaceTable() const;
    /** Writes what was asked for; throws EnvironmentError naming a file that cannot be written. */
    void write(
        const nlohmann::ordered_json& asJson,
        const std::string& asCsv,
        const std::string& singles,
        std::ostream& out) const;
};

void printTable(const ScoredResult& result, std::ostream& out);
[[nodiscard]] nlohmann::ordered_json toJson(const ScoredResult& result);
[[nodiscard]] std::string toCsv(const ScoredResult& result);

/** Writes table (if wanted), JSON and CSV as asked for; throws EnvironmentError naming a file that
 * cannot be written. */
void writeResult(
    const ScoredResult& result, const OutputFiles& files, std::ostream& out, bool table = true);

/** Lines "NAME.rmse 0.01 m" and so on, as evaluate_rpe.py and evaluate_ate.py --verbose. */
void printAsScripts(const char* name, const Statistics& error, const char* unit, std::ostream& out);

/** Reports to context.err and sets exit code 1 when the row's RMSE exceeds the threshold (negative:
 * none was given). */
void checkThreshold(
    const std::string& name, const StatisticsRow& row, double threshold, CommandContext& context);

/** Writes `text` to `path`, or to `out` for "-"; throws EnvironmentError naming the file. */
void writeText(const std::string& text, const std::string& path, std::ostream& out);

/** Share, what it is a share of, and the frames that were tracked, predicted and lost (null where
 * the file does not mark them). */
[[nodiscard]] nlohmann::ordered_json toJson(const Coverage& coverage);

/** Whatever a name holds: line breaks and the like as \\n, \\t or \\x1b. */
[[nodiscard]] std::string inOneLine(const std::string& text);

/** Names of files for a column of just so many characters. Where one is longer, what all end with
 * is left out, as in RUN/trajectory.txt. Of what is still longer, the end is shown. */
[[nodiscard]] std::vector<std::string> shownNames(
    std::vector<std::string> names, std::size_t width);

/** A stamp for --save: the fewest decimals that read back as the same number. */
[[nodiscard]] std::string savedStamp(double stamp);

/** Field of a CSV file, quoted where needed. */
[[nodiscard]] std::string csvField(const std::string& text);

/** printf to a string. */
[[nodiscard]] std::string format(const char* text, ...) __attribute__((format(printf, 1, 2)));
}  // namespace pointplane
