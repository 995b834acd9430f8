// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/scenes.h>

#include <sstream>
#include <stdexcept>

#include "scenes_internal.h"

namespace pointplane
{
namespace
{
struct Entry
{
    SceneInfo info;
    Scene (*make)(std::uint64_t seed);
};

const std::vector<Entry>& entries()
{
    static const std::vector<Entry> all{
        {{"corner", "a room corner, three planes with some texture"}, makeCorner},
        {{"desk", "objects on a desk, posters on the walls"}, makeDesk},
        {{"room", "a full turn in a furnished room, ends where it began"}, makeRoom},
        {{"notexture", "blank zigzag walls"}, makeNoTexture},
        {{"cabinet", "a walk around a cabinet, little texture"}, makeCabinet},
        {{"corridor", "a way along two blank walls, nothing else has depth"}, makeCorridor},
        {{"corridor_floor", "a way along a blank corridor with floor and ceiling"},
         makeCorridorWithFloor},
        {{"person", "a furnished room, a person walks across"}, makePerson},
        {{"push", "objects on a desk, a box is pushed over it"}, makePush},
        {{"door", "a furnished room, a cupboard's door opens and closes"}, makeDoor},
        {{"half", "a furnished room, half of the view is a printed screen that moves"}, makeHalf},
        {{"seated", "a furnished room, two people sit close, talk and gesture"}, makeSeated}};
    return all;
}
}  // namespace

const std::vector<SceneInfo>& sceneList()
{
    static const std::vector<SceneInfo> infos = []
    {
        std::vector<SceneInfo> out;
        for (const Entry& entry : entries())
        {
            out.push_back(entry.info);
        }
        return out;
    }();
    return infos;
}

Scene makeScene(const std::string& name, std::uint64_t seed)
{
    std::ostringstream known;
    for (const Entry& entry : entries())
    {
        if (entry.info.name == name)
        {
            return entry.make(seed);
        }
        known << ' ' << entry.info.name;
    }
    throw std::invalid_argument("unknown scene '" + name + "', known are:" + known.str());
}
}  // namespace pointplane
