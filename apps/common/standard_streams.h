// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace pointplane
{
/** Before anything else is opened: the first file that a program opens must not take the number of
 * a stream that is closed. Whatever is written to a closed stream fails. */
void openStandardStreams();

/** Columns of the terminal that this is, like STDOUT_FILENO; 0 if it is none, or does not tell. */
[[nodiscard]] std::size_t columnsOf(int stream);

/** Columns that help is wrapped to: COLUMNS, or those of the terminal that shows it, also by a
 * pager. 0: there is none. */
[[nodiscard]] std::size_t helpColumns();

/** Before a run whose result goes there. What only tells about a run may be lost with a closed
 * stream. \throws EnvironmentError if it was closed when the program began */
void requireStandardOutput();

/** At the end. \throws EnvironmentError if something is lost that was written to std::cout */
void flushStandardOutput();
}  // namespace pointplane
