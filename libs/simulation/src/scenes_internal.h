// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/SceneBuilder.h>

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
[[nodiscard]] Scene makePerson(std::uint64_t seed);
[[nodiscard]] Scene makePush(std::uint64_t seed);
[[nodiscard]] Scene makeDoor(std::uint64_t seed);
[[nodiscard]] Scene makeHalf(std::uint64_t seed);
[[nodiscard]] Scene makeSeated(std::uint64_t seed);

/** The room of `desk` and `room`, to which more may be added, and its light. */
[[nodiscard]] SceneBuilder furnishedRoom(const std::string& name, std::uint64_t seed);
[[nodiscard]] Lamp roomLamp();
}  // namespace pointplane
