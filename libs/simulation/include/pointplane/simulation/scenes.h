// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/Scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pointplane
{
/** Names that makeScene() knows, with a line of description each. */
struct SceneInfo
{
    std::string name;
    std::string description;
};
[[nodiscard]] const std::vector<SceneInfo>& sceneList();

/** \param seed of textures and small objects \throws std::invalid_argument listing the names */
[[nodiscard]] Scene makeScene(const std::string& name, std::uint64_t seed);
}  // namespace pointplane
