// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace pointplane::adversary
{
using App = int (*)(const std::vector<std::string>&, std::ostream&, std::ostream&);

/** What a program did. */
struct Attempt
{
    int code{-1};
    int signal{0};  //!< that ended it, or 0
    std::string out, err;
};

/** Runs the program in a process of its own, for at most a minute and in 4 GB.
 * \param disk of so many kilobytes in this folder, if not empty */
[[nodiscard]] Attempt attempt(
    App app,
    const std::vector<std::string>& args,
    const std::string& smallDisk = "",
    int kilobytes = 0);

/** A row of the table. */
class Tally
{
 public:
    explicit Tally(std::string what) : what_(std::move(what)) {}

    /** \param wrong what is wrong with it, or empty \param name of the case, for the list of
     * failures */
    void add(const Attempt& attempt, const std::string& wrong, const std::string& name);

    [[nodiscard]] static std::string header();
    [[nodiscard]] std::string row() const;
    [[nodiscard]] const std::vector<std::string>& failures() const { return failures_; }

 private:
    std::string what_;
    std::size_t tried_{0}, crashes_{0};
    std::map<int, std::size_t> codes_;
    std::vector<std::string> failures_;
};

/** Empty if the process ended by itself, and said why in one line where its exit code is not 0. */
[[nodiscard]] std::string wrongWith(const Attempt& attempt);

/** A value that names itself when it is wrong. */
[[nodiscard]] std::string unless(bool good, const std::string& problem);

/** A small folder of the TUM benchmark's layout, with everything that one may have. */
void writeTumFolder(const std::string& folder);
constexpr int kTumFrames = 4;

/** @name The kinds of attempts. share: of the full number, 0 to 1
 * @{ */
[[nodiscard]] Tally damagedRawlogs(double share);
[[nodiscard]] Tally damagedFolders(double share);
[[nodiscard]] Tally iniValues(double share);
[[nodiscard]] Tally fullDisks(double share);
[[nodiscard]] Tally sameFiles(double share);
[[nodiscard]] Tally mrptSamples(double share);
/** @} */
}  // namespace pointplane::adversary
