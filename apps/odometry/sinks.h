// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "OdometryOptions.h"
#include "OutputGuard.h"
#include "Sink.h"

namespace pointplane
{
using Sinks = std::vector<std::unique_ptr<Sink>>;

/** One for each output that is asked for. \throws EnvironmentError naming the option */
[[nodiscard]] Sinks openSinks(const OdometryOptions& options);

/** Knows what a run reads and what these sinks write.
 * \throws InputError, EnvironmentError as OutputGuard */
[[nodiscard]] OutputGuard guardOf(const OdometryOptions& options);
}  // namespace pointplane
