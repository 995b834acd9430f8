// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/evaluation/rpe.h>
#include <pointplane/mrpt_io/OutputFolder.h>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace pointplane
{
class OutputGuard;
class WorkDirectory;

/** One run of pointplane-odometry, to be scored against ground truth. */
struct LabRun
{
    std::string name;  //!< for progress and file names, e.g. "xyz alpha=3"
    std::string rawlog;
    std::string groundTruth;            //!< of the camera's optical frame
    std::string config;                 //!< ini file; empty: the built-in configuration
    std::vector<std::string> settings;  //!< Section.key=value
};

/** Its score, or why there is none. */
struct LabScore
{
    std::optional<RpeResult> rpe;
    std::string failure;
    Trajectory estimate{};  //!< what was scored
};

/** How runs are made; sweep and reproduce share the options. */
struct LabRunner
{
    std::string odometry;   //!< the program; empty: the one beside this one, or in PATH
    std::string directory;  //!< for trajectories and logs; empty: a temporary one
    std::size_t jobs{0};    //!< runs at a time; 0: one per core

    void addTo(CLI::App& command);
    void guardedBy(OutputGuard& guard) const;
    [[nodiscard]] std::string program() const;
    [[nodiscard]] std::size_t parallel() const;  //!< jobs, or the number of cores

    /** Told before hours of work. \throws InputError when there is no odometry program */
    void requireProgram() const;

    /** Makes all runs, several at a time, and scores them; runs with the same rawlog and the same
     * parameters are made once. A failed run is a score with its
     * failure, not an exception. Progress, one line per run, goes to `err`.
     * \param work made of `directory`, takes trajectories and logs */
    [[nodiscard]] std::vector<LabScore> run(
        const std::vector<LabRun>& runs,
        const RpeOptions& rpe,
        const WorkDirectory& work,
        std::ostream& err) const;
};

/** A directory that is gone with its owner, unless it was given by name. */
class WorkDirectory
{
 public:
    /** \param path is created and kept; empty: a temporary one. \throws EnvironmentError */
    explicit WorkDirectory(const std::string& path);
    ~WorkDirectory();
    WorkDirectory(const WorkDirectory&) = delete;
    WorkDirectory& operator=(const WorkDirectory&) = delete;
    /** Path for a file in it (OutputFolder). */
    [[nodiscard]] std::string fileAt(const std::string& name) const { return folder_.fileAt(name); }

 private:
    OutputFolder folder_;
    bool temporary_;
};

/** "1 of 18 runs failed, first NAME: why", or empty. */
[[nodiscard]] std::string failuresOf(
    const std::vector<LabRun>& runs, const std::vector<LabScore>& scores);

/** Adds errors, pairs and coverage, or the failure, to the JSON object of a run. */
void addScore(const LabScore& score, nlohmann::ordered_json& run);

/** Columns of scoreFields(). */
inline constexpr const char* kScoreColumns =
    "pairs,coverage,predicted,lost,rpe_m,rpe_deg,failure\n";

/** Of a line of CSV, with its end. */
[[nodiscard]] std::string scoreFields(const LabScore& score);

/** How a score is said. */
struct ScoreWords
{
    const char* mm;
    const char* deg;
    const char* lost;
    const char* predicted;
};
inline constexpr ScoreWords kLongWords{" mm", " deg", "lost", "predicted"};
inline constexpr ScoreWords kShortWords{"", "", "l", "p"};  //!< as in the paper's tables

/** " (9 lost, 3 predicted)", or empty if all frames were measured or the run failed. */
[[nodiscard]] std::string unmeasuredText(const LabScore& score, const ScoreWords& words);

/** "12.3 mm / 0.46 deg" with unmeasuredText(), or "failed". */
[[nodiscard]] std::string scoreText(const LabScore& score, const ScoreWords& words = kLongWords);
}  // namespace pointplane
