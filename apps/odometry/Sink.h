// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "FrameRecord.h"

namespace pointplane
{
/** Where results go. Called for every observation in order, from one thread. */
class Sink
{
 public:
    Sink() = default;
    virtual ~Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;

    /** \throws EnvironmentError */
    virtual void add(const OutputItem& item) = 0;
    /** Completes what was written. \throws EnvironmentError */
    virtual void close() = 0;
    /** Removes what was written: the run came to nothing. */
    virtual void discard() noexcept = 0;
    /** What is there now, for the summary: "out.rawlog: poses and observations". */
    [[nodiscard]] virtual std::string description() const = 0;
    [[nodiscard]] virtual bool needsFeatures() const { return false; }
};
}  // namespace pointplane
