// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** @name Texts of comments around a recording
 *
 * Records of a rawlog are complete each by itself, so a file that was cut between two of them looks
 * whole. A recording that begins with the one comment ends with the other, or was cut: RawlogReader
 * says so.
 * @{ */
constexpr const char* kRecordingBegins = "pointplane-recording begins";
constexpr const char* kRecordingEnds = "pointplane-recording ends";
/** @} */
}  // namespace pointplane
