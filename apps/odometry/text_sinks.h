// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "FrameRecord.h"
#include "TextOutput.h"

namespace pointplane
{
/** The accumulated poses as TUM text: `stamp tx ty tz qx qy qz qw`, one line a frame, in the
 * camera's optical frame, as the TUM tools expect, or the robot's. A comment ahead of it marks a
 * predicted frame; of a lost one there is only the comment. */
class TrajectorySink : public Sink
{
 public:
    TrajectorySink(const std::string& path, bool robotFrame);

    void add(const OutputItem& item) override;
    void close() override { file_.close(); }
    void discard() noexcept override { file_.discard(); }
    [[nodiscard]] std::string description() const override;

 private:
    TextOutput file_;
    bool robotFrame_;
};

/** FrameDiagnostics as a table, one line a frame. */
class DiagnosticsSink : public Sink
{
 public:
    explicit DiagnosticsSink(const std::string& path);

    void add(const OutputItem& item) override;
    void close() override { file_.close(); }
    void discard() noexcept override { file_.discard(); }
    [[nodiscard]] std::string description() const override;

 private:
    TextOutput file_;
};
}  // namespace pointplane
