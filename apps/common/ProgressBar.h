// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <string>

namespace pointplane
{
/** How far a run is: a bar with rate and time left on a terminal, a line now and then elsewhere. */
class ProgressBar
{
 public:
    /** \param out usually std::cerr \param isTerminal redraws one line instead of adding lines
     * \param what the name of the run, e.g. the input file */
    ProgressBar(std::ostream& out, bool isTerminal, std::string what);
    /** Ends the line. */
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /** \param fraction done, 0 to 1 \param frames done so far */
    void update(double fraction, std::size_t frames);

    /** Writes a line of its own, above the bar. */
    void message(const std::string& line);

 private:
    using Clock = std::chrono::steady_clock;
    void draw(double fraction, std::size_t frames, Clock::time_point now);

    std::ostream& out_;
    bool isTerminal_;
    std::string what_;
    Clock::time_point start_{Clock::now()};
    Clock::time_point drawn_{start_};
    bool lineOpen_{false};
};

/** True when standard error is a terminal. */
[[nodiscard]] bool standardErrorIsTerminal();

/** A line that can be redrawn: of one that is longer than the terminal's, the beginning would stay.
 * First the name loses its beginning, then the rest its end.
 * \param columns 0: the line may have any length */
[[nodiscard]] std::string lineOf(
    const std::string& name, const std::string& rest, std::size_t columns);

/** "1:02" or "1:00:05". */
[[nodiscard]] std::string durationText(double seconds);
}  // namespace pointplane
