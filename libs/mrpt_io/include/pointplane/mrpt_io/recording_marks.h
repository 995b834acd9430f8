// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** @name Texts of comments around a recording
 *
 * Each record of a rawlog is complete by itself, so a file that was cut between two of them looks
 * whole. A recording that begins with the first comment must end with the second; if it does not,
 * RawlogReader says that it was cut.
 * @{ */
constexpr const char* kRecordingBegins = "pointplane-recording begins";
constexpr const char* kRecordingEnds = "pointplane-recording ends";
/** @} */
}  // namespace pointplane
