// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/Scene.h>

#include <cstdint>

namespace pointplane
{
[[nodiscard]] Scene makeCorner(std::uint64_t seed);
[[nodiscard]] Scene makeDesk(std::uint64_t seed);
[[nodiscard]] Scene makeRoom(std::uint64_t seed);
[[nodiscard]] Scene makeNoTexture(std::uint64_t seed);
[[nodiscard]] Scene makeCabinet(std::uint64_t seed);
[[nodiscard]] Scene makeCorridor(std::uint64_t seed);
[[nodiscard]] Scene makeCorridorWithFloor(std::uint64_t seed);
}  // namespace pointplane
