// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "Sink.h"
#include "TextOutput.h"

namespace pointplane
{
/** One that writes lines. */
class TextSink : public Sink
{
 public:
    explicit TextSink(const std::string& path) : file_(path) {}

    void close() override { file_.close(); }
    void discard() noexcept override { file_.discard(); }

 protected:
    TextOutput file_;
};

/** The accumulated poses as TUM text: `stamp tx ty tz qx qy qz qw`, one line a frame, in the
 * camera's optical frame, as the TUM tools expect, or the robot's. A comment ahead of it marks a
 * predicted frame; of a lost one there is only the comment. */
class TrajectorySink : public TextSink
{
 public:
    TrajectorySink(const std::string& path, bool robotFrame);

    void add(const OutputItem& item) override;
    [[nodiscard]] std::string description() const override;

 private:
    bool robotFrame_;
};

/** FrameDiagnostics as a table, one line a frame. */
class DiagnosticsSink : public TextSink
{
 public:
    explicit DiagnosticsSink(const std::string& path);

    void add(const OutputItem& item) override;
    [[nodiscard]] std::string description() const override;
};
}  // namespace pointplane
