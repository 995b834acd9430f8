// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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

/** Where a program runs. */
struct Surroundings
{
    std::string disk{};  //!< folder that is a disk of so many kilobytes, if not empty
    int kilobytes{0};
    std::string leaves{};  //!< folder to which the disk's files are copied in the end, if not empty
    std::string folder{};  //!< in which it is started
    std::uint64_t memory{4ULL << 30U};                 //!< of its address space [bytes]
    std::optional<std::uint64_t> stack{}, fileSize{};  //!< [bytes]
    std::map<std::string, std::string> environment{};  //!< added
};

/** Runs a program in a process of its own, for at most a minute of processor time.
 * \return code -1: this user may not mount a disk */
[[nodiscard]] Attempt attempt(
    App app, const std::vector<std::string>& args, const Surroundings& surroundings = {});

/** The same with the executable pointplane-<program>: slower, with all that is done before main().
 */
[[nodiscard]] Attempt attemptOf(
    const std::string& program,
    const std::vector<std::string>& args,
    const Surroundings& surroundings = {});

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
    std::size_t tried_{0};
    std::vector<std::string> failures_;
};

/** Empty if the process ended by itself, and said why in one line where its exit code is not 0. */
[[nodiscard]] std::string wrongWith(const Attempt& attempt);

/** The same of the lines that the program says itself: the grabber also says what it has recorded,
 * and libraries that find no memory (GDAL, which OpenCV's decoders load) say so beside the program.
 */
[[nodiscard]] std::string wrongWithOwnLines(const Attempt& attempt);

/** A value that names itself when it is wrong. */
[[nodiscard]] std::string unless(bool good, const std::string& problem);

/** Options of pointplane-grabber for a short recording of the virtual camera, and more. */
[[nodiscard]] std::vector<std::string> recorder(int frames, const std::vector<std::string>& more);

/** A small folder of the TUM benchmark's layout, with everything that one may have, 1.75 s long. */
void writeTumFolder(const std::string& folder);
constexpr int kTumFrames = 8;

/** @name The kinds of attempts. share: of the full number, 0 to 1
 * @{ */
[[nodiscard]] Tally damagedRawlogs(double share);
[[nodiscard]] Tally damagedFolders(double share);
[[nodiscard]] Tally iniValues(double share);
[[nodiscard]] Tally optionValues(double share);
[[nodiscard]] Tally fullDisks(double share);
[[nodiscard]] Tally fullDisksOfGrabber(double share);
[[nodiscard]] Tally tightLimits(double share);
[[nodiscard]] Tally sameFiles(double share);
[[nodiscard]] Tally mrptSamples(double share);
/** @} */
}  // namespace pointplane::adversary
