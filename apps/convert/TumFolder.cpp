// SPDX-License-Identifier: BSD-3-Clause
#include "TumFolder.h"

#include <pointplane/core/byte_order_mark.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace pointplane
{
std::vector<TumImage> readTumListing(const std::string& folder, const std::string& listing)
{
    const std::string path = folder + "/" + listing;
    std::ifstream file(path);
    if (!file)
    {
        throw InputError("cannot open " + path + ": " + std::strerror(errno));
    }
    skipByteOrderMark(file);
    std::vector<TumImage> images;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number)
    {
        std::istringstream words(line);
        std::string stamp, name, more;
        if (!(words >> stamp) || stamp[0] == '#')
        {
            continue;
        }
        const std::string where = path + ":" + std::to_string(number) + ": ";
        if (!(words >> name) || words >> more)
        {
            throw InputError(where + "expected 'stamp file', found '" + line + "'");
        }
        try
        {
            const auto time = stampFromText(stamp);
            images.push_back(
                {time, toSeconds(time), (std::filesystem::path(folder) / name).string()});
        }
        catch (const InputError& e)
        {
            throw InputError(where + e.what());
        }
    }
    if (images.empty())
    {
        throw InputError(path + ": lists no images");
    }
    std::stable_sort(
        images.begin(),
        images.end(),
        [](const TumImage& a, const TumImage& b) { return a.stamp < b.stamp; });
    return images;
}
}  // namespace pointplane
