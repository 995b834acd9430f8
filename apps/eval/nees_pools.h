// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>

#include <vector>

namespace pointplane
{
struct CommandContext;

/** The increments of one or more runs, together for each interval. */
class NeesPools
{
 public:
    void add(const NeesRun& run);

    /** One per interval. \throws std::runtime_error if one has too few increments */
    [[nodiscard]] std::vector<NeesResult> scores() const;

    /** The same without intervals of too few increments, which are told to the user.
     * \throws std::runtime_error if no interval has enough */
    [[nodiscard]] std::vector<NeesResult> scoresOfTestable(CommandContext& context) const;

 private:
    struct Pool
    {
        NeesInterval interval;
        std::vector<NeesIncrement> increments;
        std::size_t independent{0};  //!< NeesResult::independent

        [[nodiscard]] NeesResult score() const;
        [[nodiscard]] std::string problem() const;
    };
    std::vector<Pool> pools_;
};
}  // namespace pointplane
