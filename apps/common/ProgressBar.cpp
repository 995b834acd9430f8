// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressBar.h"

#include <pointplane/core/counted.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ostream>
#include <utility>

#include "standard_streams.h"
#include <unistd.h>

namespace pointplane
{
ProgressBar::ProgressBar(std::ostream& out, bool isTerminal, std::string what)
    : out_(out), isTerminal_(isTerminal), what_(std::move(what))
{
}

ProgressBar::~ProgressBar()
{
    if (lineOpen_)
    {
        out_ << "\n";
    }
}

void ProgressBar::update(double fraction, std::size_t frames)
{
    const auto now = Clock::now();
    const std::chrono::duration<double> sinceDrawn = now - drawn_;
    if (sinceDrawn.count() < (isTerminal_ ? 0.2 : 10.0))
    {
        return;
    }
    drawn_ = now;
    draw(std::clamp(fraction, 0.0, 1.0), frames, now);
}

void ProgressBar::draw(double fraction, std::size_t frames, Clock::time_point now)
{
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(frames) / elapsed;
    std::string text = ": ";
    constexpr int kWidth = 20;
    if (isTerminal_)
    {
        const int filled = static_cast<int>(std::lround(fraction * kWidth));
        text += "[" + std::string(static_cast<std::size_t>(filled), '#') +
                std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] ";
    }
    char numbers[96];
    std::snprintf(
        numbers,
        sizeof(numbers),
        "%3.0f %%  %11s  %5.1f fps  %5s left",
        100 * fraction,
        framesText(frames).c_str(),
        rate,
        fraction > 0.01 ? durationText(elapsed / fraction - elapsed).c_str() : "-:--");
    text += numbers;
    if (isTerminal_)
    {
        out_ << "\r" << lineOf(what_, text, columnsOf(STDERR_FILENO)) << "\x1b[K" << std::flush;
        lineOpen_ = true;
    }
    else
    {
        out_ << what_ << text << "\n" << std::flush;
    }
}

void ProgressBar::message(const std::string& line)
{
    if (lineOpen_)
    {
        out_ << "\r\x1b[K";
        lineOpen_ = false;
    }
    out_ << line << "\n" << std::flush;
}

bool standardErrorIsTerminal()
{
    const char* const terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 &&
           (terminal == nullptr || std::strcmp(terminal, "dumb") != 0);
}

std::string lineOf(const std::string& name, const std::string& rest, std::size_t columns)
{
    constexpr std::size_t kLeastName = 8;
    const std::string dots = "...";
    if (columns == 0 || name.size() + rest.size() < columns)
    {
        return name + rest;
    }
    const std::size_t most = columns - 1, taken = rest.size() + dots.size();
    const std::size_t kept = std::max(kLeastName, most > taken ? most - taken : 0);
    const bool isLong = name.size() > kept + dots.size();
    return ((isLong ? dots + name.substr(name.size() - kept) : name) + rest).substr(0, most);
}

std::string durationText(double seconds)
{
    const auto total = static_cast<long>(std::max(0.0, std::round(seconds)));
    char text[48];
    if (total >= 3600)
    {
        std::snprintf(
            text, sizeof(text), "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
    }
    else
    {
        std::snprintf(text, sizeof(text), "%ld:%02ld", total / 60, total % 60);
    }
    return text;
}
}  // namespace pointplane
