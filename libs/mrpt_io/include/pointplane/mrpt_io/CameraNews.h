// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <string>

namespace pointplane
{
/** What is to be told of a camera before a frame, as a comment for
 * ObservationConverter::readComment(): the delay between depth and colour, and whether the
 * intrinsics are nominal. One object per file: a reader of it knows nothing yet. */
class CameraNews
{
 public:
    explicit CameraNews(std::string label) : label_(std::move(label)) {}

    /** \param depthDelay ShutterModel::depthDelay; not finite: what was told last still holds
     * \return the comment, or empty if nothing has changed */
    [[nodiscard]] std::string before(double depthDelay, bool isNominal);

 private:
    std::string label_;
    ShutterModel told_;
    bool isNominal_{false};
};
}  // namespace pointplane
