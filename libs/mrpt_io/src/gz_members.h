// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pointplane
{
/** Identifies the field in a member's gz header (RFC 1952: extra field, SI1 and SI2) that says that
 * another member follows. */
constexpr std::array<std::uint8_t, 2> kAnotherFollows{'P', 'P'};
}  // namespace pointplane
